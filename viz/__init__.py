"""Seeing: Meshcat scenes of stances, one-file pages of stances, studies and motions, plots for papers.

The functions load on first use, so that `import rover_pin` stays light.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rover_pin.viz.browser import save_png as save_png
    from rover_pin.viz.comparison import plot_pair as plot_pair
    from rover_pin.viz.comparison import plot_spreads as plot_spreads
    from rover_pin.viz.mobility import plot_mobility as plot_mobility
    from rover_pin.viz.motion import motion_page as motion_page
    from rover_pin.viz.motion import save_motion_html as save_motion_html
    from rover_pin.viz.motion import save_motion_png as save_motion_png
    from rover_pin.viz.motion_plots import plot_run as plot_run
    from rover_pin.viz.page.compare import save_comparison_page as save_comparison_page
    from rover_pin.viz.page.measured import worst_cases as worst_cases
    from rover_pin.viz.page.result import result_page as result_page
    from rover_pin.viz.page.result import save_result_page as save_result_page
    from rover_pin.viz.page.search import save_search_page as save_search_page
    from rover_pin.viz.page.sensitivity import save_sensitivity_page as save_sensitivity_page
    from rover_pin.viz.page.several import exact_cases as exact_cases
    from rover_pin.viz.page.study import save_study_page as save_study_page
    from rover_pin.viz.plots import plot_distributions as plot_distributions
    from rover_pin.viz.plots import plot_map as plot_map
    from rover_pin.viz.scene import draw as draw
    from rover_pin.viz.serve import serve as serve
    from rover_pin.viz.show import save_html as save_html
    from rover_pin.viz.show import show as show
    from rover_pin.viz.slopes import plot_slopes as plot_slopes
    from rover_pin.viz.slopes import save_slopes_html as save_slopes_html
    from rover_pin.viz.traverse import plot_traverse as plot_traverse
    from rover_pin.viz.traverse import save_traverse_plot as save_traverse_plot
    from rover_pin.viz.traverse_motion import save_traverse_html as save_traverse_html

_HOME = {
    "draw": "scene",
    "exact_cases": "page.several",
    "motion_page": "motion",
    "plot_distributions": "plots",
    "plot_map": "plots",
    "plot_mobility": "mobility",
    "plot_pair": "comparison",
    "plot_run": "motion_plots",
    "plot_slopes": "slopes",
    "plot_spreads": "comparison",
    "plot_traverse": "traverse",
    "result_page": "page.result",
    "save_comparison_page": "page.compare",
    "save_html": "show",
    "save_motion_html": "motion",
    "save_motion_png": "motion",
    "save_png": "browser",
    "save_result_page": "page.result",
    "save_search_page": "page.search",
    "save_sensitivity_page": "page.sensitivity",
    "save_slopes_html": "slopes",
    "save_study_page": "page.study",
    "save_traverse_html": "traverse_motion",
    "save_traverse_plot": "traverse",
    "serve": "serve",
    "show": "show",
    "worst_cases": "page.measured",
}

__all__ = sorted(_HOME)


def __getattr__(name: str) -> object:
    """Load the module that holds `name`."""
    if name not in _HOME:
        raise AttributeError(f"module 'rover_pin.viz' has no attribute {name!r}")
    return getattr(importlib.import_module(f"rover_pin.viz.{_HOME[name]}"), name)
