"""A local web app: set a problem, watch its solve, see the walker, lay gaits over each other."""
