"""What the site's builder does to every page, so that it needs no network and can be reached.

Equations become MathML; the script that lets a page search without a server is taken from the
site itself; what scrolls can be scrolled by keys.
"""

from __future__ import annotations

import html
import re
from typing import Any

from latex2mathml.converter import convert

WORKER = "iframe-worker.js"
"""MIT, https://github.com/squidfunk/iframe-worker, version 1.0.4."""

_MATH = re.compile(
    r'<(span|div) class="arithmatex">(?:\\\((.*?)\\\)|\\\[(.*?)\\\])</\1>', flags=re.DOTALL
)


def on_page_content(content: str, **_: Any) -> str:
    """Replace equations in LaTeX by MathML; an empty corner of a table heads no column."""

    def shown(match: re.Match[str]) -> str:
        inline, block = match[2], match[3]
        if inline is not None:
            return str(convert(html.unescape(inline).strip()))
        made = convert(html.unescape(block).strip(), display="block")
        return f'<div class="equation" tabindex="0" role="math">{made}</div>'

    return _MATH.sub(shown, content).replace("<th></th>", "<td></td>")


_SECTION = re.compile(r'aria-labelledby="(__nav_\w+)_label"([^>]*>\s*<label class="md-nav__title")')
"""A list of pages: the theme names it by a label that is empty where the section has a page."""


def on_post_template(output_content: str, **_: Any) -> str:
    """Name what the page for what is not found leaves without a name."""
    return _named(output_content)


def _named(output: str) -> str:
    output = output.replace('role="dialog"', 'role="dialog" aria-label="Search"')
    return _SECTION.sub(r'aria-labelledby="\1_title"\2 id="\1_title"', output)


def on_post_page(output: str, *, page: Any, **_: Any) -> str:
    """Keep the page to itself, and reachable by keys."""
    above = "../" * page.file.url.count("/")
    output = output.replace("https://unpkg.com/iframe-worker/shim", f"{above}{WORKER}")
    return re.sub(r"(<pre[^>]*>(?:<span></span>)?)<code", r'\1<code tabindex="0"', _named(output))
