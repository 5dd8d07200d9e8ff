"""Wide tables, formulas and outputs scroll in themselves, and by keyboard: they can have the focus."""

from __future__ import annotations

from typing import Any

_SCRIPT = """
addEventListener("DOMContentLoaded", () => {
  const wide = "div.highlight pre, div.math, .pst-scrollable-table-container, .cell_output .output, .bd-article table";
  const reach = () => {
    for (const box of document.querySelectorAll(wide)) {
      if (box.scrollWidth > box.clientWidth || box.matches("div.math")) box.tabIndex = 0;
    }
  };
  reach();
  document.addEventListener("toggle", reach, true);  // a fold that opens
  for (const image of document.querySelectorAll(".cell_output img:not([alt]), .cell_output img[alt*='/']")) {
    const heading = image.closest("section")?.querySelector("h1, h2, h3, h4");
    image.alt = "Figure: " + (heading ? heading.textContent.replace("#", "").trim() : document.title);
  }
});
"""


def setup(app: Any) -> dict[str, bool]:
    """Give every page the few lines."""
    app.add_js_file(None, body=_SCRIPT)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
