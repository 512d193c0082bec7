"""What a session leaves behind: its folder, its bag read back, checks, summary, picture and report."""
