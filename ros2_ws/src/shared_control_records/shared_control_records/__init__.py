"""What is kept and shown: bags, sessions, studies, reports, exports, validation."""
