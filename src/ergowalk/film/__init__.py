"""A gait as a film: mp4, gif or webp."""

from ergowalk.film.options import FORMATS, FilmOptions
from ergowalk.film.writing import film

__all__ = ["FORMATS", "FilmOptions", "film"]
