"""A session's bag for others: Parquet, and the LeRobot data set format, at the policy's rate."""
