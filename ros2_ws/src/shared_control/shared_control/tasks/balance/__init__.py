"""The task of the thesis: bring the ball to the centre of the tray and keep it there, by one moment."""
