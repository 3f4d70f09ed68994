"""A figure that shows itself: in a notebook without a magic word, from a script in a window."""

from __future__ import annotations

import io
from typing import Any

from matplotlib.figure import Figure

from .errors import InputError


class NotebookFigure(Figure):  # type: ignore[misc]
    """A matplotlib figure that pyplot knows nothing of until it is shown."""

    def _repr_png_(self) -> bytes:
        stream = io.BytesIO()
        self.savefig(stream, format="png")
        return stream.getvalue()

    def show(self, warn: bool = True) -> None:
        """Show it in a window, and wait until that is closed; refused without a screen."""
        import matplotlib
        from matplotlib import pyplot

        window: Any = pyplot.figure()
        if matplotlib.get_backend().lower() == "agg":
            pyplot.close(window)
            raise InputError(
                "no screen", key="show", allowed="a screen, or savefig with a file's name"
            )
        manager = window.canvas.manager
        manager.canvas.figure = self
        self.set_canvas(manager.canvas)
        pyplot.show()
