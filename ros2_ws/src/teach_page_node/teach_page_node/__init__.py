"""A page to teach from: the arm in 3D, the keys, the lesson; and the replay of a recorded session."""
