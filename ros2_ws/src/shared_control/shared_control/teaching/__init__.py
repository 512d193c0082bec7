"""People who teach: from key presses to the human's moment, and simulated tutors."""
