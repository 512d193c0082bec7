"""What a person who teaches is shown of the graph, and may ask of it: for the terminal and the page."""
