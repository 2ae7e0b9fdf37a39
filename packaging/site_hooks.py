# SPDX-License-Identifier: Apache-2.0
"""For mkdocs build: code in tables, and links to headings."""
import glob
import os
import re

from mkdocs.exceptions import PluginError


def on_page_markdown(markdown, **_):
    """GitHub wants a bar in code within a table escaped; Python-Markdown takes it as it is, and shows the escape."""
    return "\n".join(re.sub(r"`[^`]*`", lambda code: code[0].replace(r"\|", "|"), line) if line.startswith("|") else line
                     for line in markdown.split("\n"))


def on_post_build(config, **_):
    """mkdocs looks for the pages that links name, and this for their headings."""
    site, pages = config["site_dir"], {}
    for path in glob.glob(os.path.join(site, "**", "*.html"), recursive=True):
        name = os.path.relpath(path, site)
        if name != "404.html":
            with open(path, encoding="utf-8") as file:
                pages[name] = file.read()
    headings = {name: set(re.findall(r'\bid="([^"]+)"', page)) for name, page in pages.items()}
    wrong = [f"{name}: {to}#{heading}" for name, page in pages.items()
             for to, heading in re.findall(r'href="((?:[a-z_./]+\.html)?)#([^"]+)"', page)
             if heading not in headings.get(os.path.normpath(os.path.join(os.path.dirname(name), to)) if to else name, ())]
    if wrong:
        raise PluginError("links to headings that are not there: " + ", ".join(wrong))
