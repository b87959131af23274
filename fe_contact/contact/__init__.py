"""The contact problem, its Newton and its line search; enforcement, one law a file."""
