"""Pictures: the paper's Figures 2-10 and an overview, as matplotlib figures or files."""

from ergowalk.plots.pages import FIGURES, figures, write_figures

__all__ = ["FIGURES", "figures", "write_figures"]
