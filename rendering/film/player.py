"""A page that plays a video with its steps beside it: the current one is highlighted, a click jumps to one."""

from collections.abc import Sequence
from html import escape

from hearth.schemas.rows import FilmedStepRow

_STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; margin: 2rem; color: #23262c; background: #fafaf8; }
main { display: flex; flex-wrap: wrap; gap: 2rem; align-items: flex-start; }
video { max-width: 100%; background: #111; }
ol { list-style: none; margin: 0; padding: 0; min-width: 18rem; }
li { padding: .25rem .75rem; border-left: 4px solid transparent; cursor: pointer; }
li { font-family: ui-monospace, monospace; }
li:focus-visible { outline: 2px solid #3f77b5; }
li[aria-current] { background: #e4ecf5; border-color: #3f77b5; }
small { color: #5a5f66; }
"""

_SCRIPT = """
const video = document.querySelector("video"), steps = [...document.querySelectorAll("li")];
function show() {
  for (const step of steps) {
    const now = video.currentTime >= +step.dataset.start && video.currentTime < +step.dataset.end;
    if (now) step.setAttribute("aria-current", "step"); else step.removeAttribute("aria-current");
  }
}
for (const step of steps) {
  step.onclick = () => { video.currentTime = +step.dataset.start; };
  step.onkeydown = event => { if (event.key === "Enter") step.onclick(); };
}
video.ontimeupdate = video.onseeked = show;
show();
"""


def page(title: str, files: Sequence[str], steps: Sequence[FilmedStepRow]) -> str:
    """One HTML document that plays the video files beside it.

    Args:
        title: over the video.
        files: names of the video in several formats; the browser plays the first that it supports.
        steps: `tick`, `steps` (texts), `start` and `end` in seconds, as `video.times` gives them.
    """
    sources = "".join(f'<source src="{escape(name, quote=True)}">' for name in files)
    rows = "\n".join(_row(step) for step in steps)
    return f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>{escape(title)}</title>
<style>{_STYLE}</style>
</head>
<body>
<h1>{escape(title)}</h1>
<main>
<video controls muted>{sources}</video>
<ol>
{rows}
</ol>
</main>
<script>{_SCRIPT}</script>
</body>
</html>
"""


def _row(step: FilmedStepRow) -> str:
    text = escape(" | ".join(step["steps"]) or "start")
    times = f'data-start="{step["start"]}" data-end="{step["end"]}"'
    return f'<li tabindex="0" {times}>{text} <small>{step["start"]:.1f} s</small></li>'
