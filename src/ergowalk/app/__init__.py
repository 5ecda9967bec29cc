"""A local web app: set a problem, watch its solve, see the walker, lay gaits over each other."""

from ergowalk.app.options import Options
from ergowalk.app.serving import serve

__all__ = ["Options", "serve"]
