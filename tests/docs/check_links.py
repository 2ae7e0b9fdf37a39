#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check_links.py SOURCE: links of README and docs that lead nowhere: to a file that is not there, or to a heading that its page has not.
Pages in no list of mkdocs.yml are told, too."""
import glob
import os
import re
import sys

SOURCE = os.path.abspath(sys.argv[1])
PAGES = [os.path.join(SOURCE, "README.md"), *sorted(glob.glob(os.path.join(SOURCE, "docs", "**", "*.md"), recursive=True))]


def text_of(page):
    """A page without its code."""
    with open(page, encoding="utf-8") as file:
        return re.sub(r"^```.*?^```$", "", file.read(), flags=re.M | re.S)


def anchors(page):
    """Of its headings, as GitHub makes them."""
    headings = re.findall(r"^#+ +(.*)$", text_of(page), re.M)
    plain = (re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading) for heading in headings)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in plain}


def dead_links(page):
    text = re.sub(r"`[^`]*`", "", text_of(page))
    targets = re.findall(r"\]\(([^)\s]+)\)", text) + re.findall(r'(?:src|href)="([^"]+)"', text)
    for target in targets:
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        file = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
        if not os.path.exists(file):
            yield f"{os.path.basename(page)}: there is no {target}"
        elif anchor and anchor not in anchors(file):
            yield f"{os.path.basename(page)}: {os.path.basename(file)} has no heading #{anchor}"


def main():
    errors = [error for page in PAGES for error in dead_links(page)]
    with open(os.path.join(SOURCE, "mkdocs.yml"), encoding="utf-8") as file:
        listed = set(re.findall(r": ([\w/]+\.md)$", file.read(), re.M))
    names = [os.path.relpath(page, os.path.join(SOURCE, "docs")) for page in PAGES[1:]]
    errors += [f"mkdocs.yml does not list {name}" for name in names if name not in listed]
    if len(PAGES) < 2 or errors:
        raise SystemExit("\n".join(errors) or "there are no pages")


main()
