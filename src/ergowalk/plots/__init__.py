"""Pictures: the paper's Figures 2-10 and an overview, as matplotlib figures or files."""

from ergowalk.plots.pages import FIGURES, figures, write_figures
from ergowalk.plots.sheets import JOURNAL, SCREEN, Sheet

__all__ = ["FIGURES", "JOURNAL", "SCREEN", "Sheet", "figures", "write_figures"]
