"""The stride as a dataset, its energy, and its file."""
