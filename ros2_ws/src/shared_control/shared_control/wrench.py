"""The components of a wrench at the tray, by row."""

COMPONENTS = (('force', 'x'), ('force', 'y'), ('force', 'z'), ('torque', 'x'), ('torque', 'y'), ('torque', 'z'))
"""Where a row stands in a geometry_msgs/Wrench. A task names the rows that it shares (``Task.axes``)."""
AXIS_NAMES = ('f_x', 'f_y', 'f_z', 'm_x', 'm_y', 'm_z')
"""Names of the rows, for columns of tables."""
