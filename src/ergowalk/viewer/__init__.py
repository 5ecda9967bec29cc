"""A gait to look at: one HTML file with the walker in motion, its curves and its figures."""

from ergowalk.viewer.human import human_payload
from ergowalk.viewer.map_page import map_html, packed
from ergowalk.viewer.page import payloads, report_html
from ergowalk.viewer.payload import gait_payload

__all__ = ["gait_payload", "human_payload", "map_html", "packed", "payloads", "report_html"]
