"""What a film is to be like."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from ergowalk.errors import InputError
from ergowalk.values import Value, invalid

FORMATS = ("mp4", "gif", "webp")

MOST_FRAMES = 6000
"""Longest film: two minutes at 50 frames a second."""

MOST_PIXELS = 400e6
"""Most pixels of all frames of a gif or webp, which are held in memory: 1.2 GB."""

GIF_FASTEST = 50.0
"""Frames a second that browsers still show in their time: they take a shorter delay for 0.1 s."""

STRIDES = {"mp4": 4, "gif": 1, "webp": 1}
"""Strides where none are asked for: gif and webp begin anew by themselves."""


class FilmOptions(Value):
    """Format, size and time of a film.

    Parameters
    ----------
    format : {"mp4", "gif", "webp"}
    width, height : int
        Pixels, 160x120 to 3840x2160, even in an mp4.
    fps : float
        Frames per second, 1 to 120; a gif takes up to 50.
    strides : int, optional
        How many; without it 4 in an mp4 and 1 in the others.
    speed : float
        1 as in life, 0.25 for slow motion.
    dark : bool
        Light on dark.
    trail : bool
        The cyclogram behind the walker.

    Raises
    ------
    InputError
        For a value that no film can have.
    """

    format: str = Field(description=f"one of {', '.join(FORMATS)}")
    width: int = Field(default=960, ge=160, le=3840, strict=True, description="width in pixels")
    height: int = Field(default=540, ge=120, le=2160, strict=True, description="height in pixels")
    fps: Annotated[
        float, Field(ge=1, le=120, strict=True, description="frames per second, 1 to 120")
    ] = 50.0
    strides: int | None = Field(
        default=None, ge=1, le=100, strict=True, description="strides, 1 to 100"
    )
    speed: Annotated[
        float, Field(ge=0.02, le=10, strict=True, description="speed, 1 as in life, 0.25 slower")
    ] = 1.0
    dark: bool = Field(default=False, description="light on dark")
    trail: bool = Field(default=False, description="the cyclogram behind the walker")

    def pixels(self, frames: int) -> int:
        """Pixels of so many frames."""
        return frames * self.width * self.height

    @property
    def count(self) -> int:
        """Strides shown."""
        return STRIDES[self.format] if self.strides is None else self.strides

    def frames(self, stride_time: float) -> int:
        """Number of frames; the film is at most half a frame longer or shorter than the strides.

        Raises
        ------
        InputError
            If there are more than :data:`MOST_FRAMES`, or fewer than two, or more pixels than
            :data:`MOST_PIXELS` in a format that is written all at once.
        """
        number = round(self.count * stride_time / self.speed * self.fps)
        if not 2 <= number <= MOST_FRAMES:
            raise InputError(
                f"makes a film of {number} frames; must be 2 to {MOST_FRAMES}",
                "ask for other strides, frames per second or speed",
                field="strides",
                value=self.count,
            )
        if self.format != "mp4" and self.pixels(number) > MOST_PIXELS:
            raise InputError(
                f"makes {number} frames of {self.width}x{self.height}, more than memory should "
                f"hold of a {self.format}",
                "ask for a smaller picture, fewer strides or frames per second, or an mp4",
                field="size",
            )
        return number

    def starts(self, frames: int, ticks: int) -> list[int]:
        """When each frame begins, and the film ends, in ticks of which a second has ``ticks``."""
        return [round(i * ticks / self.fps) for i in range(frames + 1)]

    @model_validator(mode="after")
    def _can_be_written(self) -> Self:
        if self.format not in FORMATS:
            raise invalid(
                "format", self.format, "no such film format", f"choose {', '.join(FORMATS)}"
            )
        for field, value in (("width", self.width), ("height", self.height)):
            if self.format == "mp4" and value % 2:
                raise invalid(field, value, "must be even in an mp4", "add a pixel")
        if self.format == "gif" and self.fps > GIF_FASTEST:
            rule = f"must be at most {GIF_FASTEST:g} in a gif, as browsers show no more"
            raise invalid("fps", self.fps, rule, "ask for fewer, or for an mp4 or webp")
        return self
