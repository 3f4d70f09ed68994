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
    """Replace equations in LaTeX by MathML."""

    def shown(match: re.Match[str]) -> str:
        inline, block = match[2], match[3]
        if inline is not None:
            return str(convert(html.unescape(inline).strip()))
        made = convert(html.unescape(block).strip(), display="block")
        return f'<div class="equation" tabindex="0" role="math">{made}</div>'

    return _MATH.sub(shown, content)


def on_post_page(output: str, *, page: Any, **_: Any) -> str:
    """Keep the page to itself, and reachable by keys."""
    above = "../" * page.file.url.count("/")
    output = output.replace("https://unpkg.com/iframe-worker/shim", f"{above}{WORKER}")
    output = output.replace('role="dialog"', 'role="dialog" aria-label="Search"')
    return re.sub(r"(<pre[^>]*>(?:<span></span>)?)<code", r'\1<code tabindex="0"', output)
