#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""extract_code.py OUTPUT PAGE...: the C++ of pages as one source. The blocks of a page follow each other in a function; main calls the last
page's."""
import re
import sys


def main():
    output, *pages = sys.argv[1:]
    includes, functions = set(), []
    for number, page in enumerate(pages):
        with open(page, encoding="utf-8") as file:
            blocks = re.findall(r"^```cpp\n(.*?)^```$", file.read(), re.M | re.S)
        if not blocks:
            raise SystemExit(f"{page} has no C++")
        lines = "".join(blocks).splitlines()
        includes.update(line for line in lines if line.startswith("#include"))
        functions.append("\n".join([f"void page_{number}() {{", *(line for line in lines if not line.startswith("#include")), "}"]))
    with open(output, "w", encoding="utf-8") as file:
        file.write("\n".join([*sorted(includes), *functions, f"int main() {{ page_{len(pages) - 1}(); }}", ""]))


main()
