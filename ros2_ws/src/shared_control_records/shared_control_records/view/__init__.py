"""A session in Rerun: everything that its bag holds, on one time line."""
