"""What is done with a point map, whoever made it: follow it, carry values along it, write it."""
