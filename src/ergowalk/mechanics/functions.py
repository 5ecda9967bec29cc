"""Elementary functions for numbers, NumPy arrays and CasADi expressions alike.

Every formula of the model is written once, in terms of these, so that the solver's symbols and
the samples of a finished gait go through the same lines.
"""

from __future__ import annotations

from typing import Any

import numpy as np


def sin(x: Any) -> Any:
    """Sine of radians."""
    return x.sin() if hasattr(x, "sin") else np.sin(x)


def cos(x: Any) -> Any:
    """Cosine of radians."""
    return x.cos() if hasattr(x, "cos") else np.cos(x)
