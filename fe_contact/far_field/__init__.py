"""What stands for the infinite body outside the mesh. One condition a file."""
