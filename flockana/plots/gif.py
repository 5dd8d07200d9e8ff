"""GIF films that last as long as asked: the format counts in hundredths of a second."""

import itertools
from io import BytesIO
from typing import Any

from matplotlib.animation import AbstractMovieWriter
from PIL import Image


def durations(frames: int, fps: float) -> list[int]:
    """Return the time of each frame in milliseconds, whole hundredths whose sum is right."""
    ends = [round(100.0 * k / fps) for k in range(frames + 1)]
    return [10 * (end - start) for start, end in itertools.pairwise(ends)]


class GifWriter(AbstractMovieWriter):
    """Writer that collects frames and saves them as a GIF that repeats."""

    def setup(self, fig: Any, outfile: Any, dpi: float | None = None) -> None:
        """Begin a film."""
        super().setup(fig, outfile, dpi=dpi)
        self._images: list[Image.Image] = []

    def grab_frame(self, **savefig_kwargs: Any) -> None:
        """Take the figure as the next frame."""
        with BytesIO() as data:
            self.fig.savefig(data, **{**savefig_kwargs, "format": "rgba", "dpi": self.dpi})
            frame = Image.frombytes("RGBA", self.frame_size, data.getvalue())
        self._images.append(frame.convert("RGB"))

    def finish(self) -> None:
        """Write the file."""
        first, *others = self._images
        times = durations(len(self._images), self.fps)
        first.save(self.outfile, "GIF", save_all=True, append_images=others, duration=times, loop=0)
