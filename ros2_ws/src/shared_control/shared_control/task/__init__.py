"""The task: bring the ball to the centre of the tray and keep it there."""
