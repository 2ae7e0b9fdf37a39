# SPDX-License-Identifier: Apache-2.0
"""For mkdocs build: pages of everything public, a page a C++ header and a page a part of the Python module.

C++ comes from Doxygen's XML of include/vantage, Python from the types of python/vantage/__init__.pyi and the docstrings of the installed
module. What has no comment or docstring ends the build.
"""
import ast
import html
import importlib
import inspect
import itertools
import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PAGES = os.path.join(ROOT, "build", "reference", "pages")
MODULE = os.path.join(ROOT, "build", "release", "tests", "python", "module")  # where ctest -R python.install puts it
WIDE = 78  # characters of a signature in one line

pages = {}    # text of each page by its path
symbols = {}  # page and heading of each name, by language; None if it has several


class Page:
    """A page in the making: a title, and its parts as Markdown."""

    def __init__(self, language, name, title):
        self.language, self.title, self.path, self.parts = language, title, f"reference/{language}/{name}.md", [f"# {title}"]
        self.intro, self.types, self.missing, self.anchors = "", [], [], set()

    def add(self, text):
        self.parts.append(text)

    def anchor(self, name):
        """The place of a name; the first of several declarations on a page has it. A name of several pages leads nowhere."""
        known = symbols[self.language].setdefault(name, (self.path, name))
        if known and known[0] != self.path:
            symbols[self.language][name] = None
        if name in self.anchors:
            return ""
        self.anchors.add(name)
        return f' id="{name}"'

    def heading(self, level, name, kind=""):
        """Overloads share one."""
        if self.anchor(name):
            label = (f'<span class="kind">{kind}</span> ' if kind else "") + name.replace("*", "&#42;")
            self.add(f'{"#" * level} {label} {{: #{name} }}')

    def members(self, rows):
        """A list of (anchors, declarations, text)."""
        self.add('<dl class="members">\n' + "\n".join(
            "".join(f"<dt{self.anchor(name)}><code>{declaration}</code></dt>\n" for name, declaration in declarations) + f"<dd>{text}</dd>"
            for declarations, text in rows) + "\n</dl>")

    def finish(self):
        pages[self.path] = "\n\n".join(self.parts) + "\n"


def errors_apart(text):
    """A sentence on what a call throws or requires begins a paragraph of its own."""
    text = re.sub(r"(?<=[.):;] )(Throws|Raises|REQUIRES)\b", r"</p>\n<p>\1", text)
    return re.sub(r"<p>(Throws|Raises|REQUIRES)\b", r'<p class="errors"><strong>\1</strong>', text)


def first_sentence(text):
    """Plain, from HTML."""
    plain = re.sub(r"\s+", " ", re.sub(r"<[^>]*>", "", text.split("</p>")[0])).strip()
    return re.split(r"(?<=[.:]) (?=[A-Z])", plain)[0]


def call(name, parameters, before="", after=""):
    """The signature of a call, in one line if it fits."""
    plain = len(re.sub(r"<[^>]*>|&\w+;", "", before + name + ", ".join(parameters) + after))
    inner = ", ".join(parameters) if plain <= WIDE else "\n    " + ",\n    ".join(parameters)
    return f'<pre class="declaration"><code>{before}<b>{html.escape(name)}</b>({inner}){after}</code></pre>'


# --- C++ ---

TAGS = {"para": "p", "computeroutput": "code", "itemizedlist": "ul", "orderedlist": "ol", "listitem": "li", "emphasis": "em", "bold": "strong"}
SIGNS = {"ndash": "–", "mdash": "—", "linebreak": "<br>"}
places = {}  # page and heading of each id of Doxygen's


def cpp_html(node, here):
    """Doxygen's XML as HTML, without the node's own tag."""
    inner = html.escape(node.text or "", quote=False)
    for child in node:
        text = cpp_html(child, here)
        if child.tag == "ref":
            page, heading = places.get(child.get("refid"), (None, None))
            inner += f'<a href="{link(here, page)}#{heading}">{text}</a>' if page else text
        elif child.tag in TAGS:
            inner += f"<{TAGS[child.tag]}>{text}</{TAGS[child.tag]}>"
        elif child.tag in SIGNS:
            inner += SIGNS[child.tag]
        else:
            raise PluginError(f"reference.py cannot show <{child.tag}> of Doxygen")
        inner += html.escape(child.tail or "", quote=False)
    return inner


def link(here, there):
    """The address of a page on another."""
    return os.path.relpath(there.replace(".md", ".html"), os.path.dirname(here))


def cpp_doc(node, here):
    return errors_apart(re.sub(r"\s+(?=</p>)", "", "".join(cpp_html(node.find(part), here).strip()
                                                          for part in ("briefdescription", "detaileddescription"))))


def cpp_type(node, here):
    """A type or an initial value, spaced as the headers space it."""
    if node is None:
        return ""
    text = cpp_html(node, here).strip()
    text = re.sub(r"\s*(&lt;)\s*|\s+(?=&gt;)", r"\1", text)
    return re.sub(r"(&amp;|\*)(?=\w)", r"\1 ", re.sub(r" (?=&amp;|\*)", "", text))


def is_public(member):
    """True if pages show it: they leave out what is private, what every class has, and the constructors of a base."""
    name, arguments = member.findtext("name"), member.findtext("argsstring") or ""
    if member.get("prot") != "public" or name.startswith("~") or arguments.endswith(("=default", "=delete")):
        return False
    if member.get("kind") != "function":
        return member.get("kind") != "friend" or member.get("inline") == "yes"
    if re.match(rf"\({name} &&\)", arguments) or name == "operator=" and "&&" in arguments:
        return False
    constructor = not "".join(member.find("type").itertext()) and not name.startswith("operator")
    return not constructor or cpp_name(member).endswith(f"{name}::{name}")


def line_of(node):
    return int(node.find("location").get("line")), int(node.find("location").get("column") or 0)


def cpp_members(compound, every):
    """Members and inner types of a class in the order of the header."""
    inner = [every[child.get("refid")] for child in compound.findall("innerclass") if child.get("prot") == "public"]
    members = [member for member in compound.iter("memberdef") if is_public(member)]
    return sorted(inner + members, key=line_of)


def cpp_name(node):
    name = node.findtext("compoundname") or node.findtext("qualifiedname")
    return re.sub(r"^vantage::", "", name)


class CppPage(Page):
    def __init__(self, header, every):
        super().__init__("cpp", header.findtext("compoundname").replace(".hpp", ""), header.findtext("compoundname"))
        self.every, self.header = every, header

    def told(self, node, text, within=None):
        """The text, which must not be empty. A value of an enumeration has no place of its own."""
        if not text:
            place = (node if within is None else within).find("location")
            name = cpp_name(node) if within is None else f'{cpp_name(within)}::{node.findtext("name")}'
            self.missing.append(f'{place.get("file")}:{place.get("line")}: {name}')
        return text

    def reference(self, node):
        page, heading = places.get(node.get("refid"), (None, None))
        return f'<a href="{link(self.path, page)}#{heading}">{heading}</a>' if page else html.escape(node.text)

    def template(self, node):
        of = node.find("templateparamlist")
        return "" if of is None else "template &lt;" + ", ".join(
            " ".join(filter(None, (cpp_type(p.find("type"), self.path), p.findtext("declname")))) for p in of) + "&gt;\n"

    def function(self, member, level):
        self.heading(level, cpp_name(member))
        parameters = []
        for p in member.findall("param"):
            default = cpp_type(p.find("defval"), self.path)
            parameters.append(" ".join(filter(None, (cpp_type(p.find("type"), self.path), p.findtext("declname")))) + (f" = {default}" if default else ""))
        words = [word for word, key in (("static", "static"), ("explicit", "explicit"), ("virtual", "virt")) if member.get(key, "no") not in ("no", "non-virtual")]
        before = self.template(member) + "".join(word + " " for word in [*words, cpp_type(member.find("type"), self.path)] if word)
        after = re.sub(r"^.*\)", "", member.findtext("argsstring")).replace("=0", " = 0")
        self.add(call(member.findtext("name"), parameters, before, html.escape(after)))
        self.add(self.told(member, cpp_doc(member, self.path)))

    def enumeration(self, node, level):
        self.heading(level, cpp_name(node), "enum")
        self.add(self.told(node, cpp_doc(node, self.path)))
        self.members([([(f'{cpp_name(node)}::{value.findtext("name")}', f'<b>{value.findtext("name")}</b>')],
                       self.told(value, cpp_doc(value, self.path), node)) for value in node.findall("enumvalue")])

    def variables(self, members):
        """Declarators of one statement share a comment."""
        rows = []
        for _, together in itertools.groupby(members, lambda member: member.get("statement")):
            together = list(together)
            declarations = []
            for member in together:
                type_, name = cpp_type(member.find("type"), self.path), f'<b>{member.findtext("name")}</b>'
                value = cpp_type(member.find("initializer"), self.path)
                declaration = f"using {name} = {type_}" if member.get("kind") == "typedef" else f"{type_} {name}" + (f" {value}" if value.startswith("=") else value)
                declarations.append((cpp_name(member), self.template(member) + declaration))
            texts = dict.fromkeys(cpp_doc(member, self.path) for member in together)
            rows.append((declarations, self.told(together[0], "".join(texts))))
        self.members(rows)

    def type(self, compound, level):
        name = cpp_name(compound)
        self.heading(level, name, compound.get("kind"))
        bases = ", ".join(self.reference(base) for base in compound.findall("basecompoundref"))
        of = self.template(compound)
        if of or bases:
            self.add(f'<pre class="declaration"><code>{of}{compound.get("kind")} <b>{name}</b>{bases and " : " + bases}</code></pre>')
        self.add(self.told(compound, cpp_doc(compound, self.path)))
        self.list(cpp_members(compound, self.every), min(level + 1, 4))

    def list(self, entries, level):
        """Entries in the order of the header. Variables of a class stand in one list; others have a heading for each statement."""
        def together(entry):
            if entry.get("kind") not in ("variable", "typedef"):
                return entry.get("id")
            return entry.get("statement") if level == 2 else "members"

        for _, group in itertools.groupby(entries, together):
            group = [*group]
            first, kind = group[0], group[0].get("kind")
            if first.tag == "compounddef":
                self.type(first, level)
            elif kind == "enum":
                self.enumeration(first, level)
            elif kind in ("function", "friend"):
                self.function(first, level)
            else:
                if level == 2:
                    self.heading(level, cpp_name(first), "constant" if kind == "variable" else "type")
                self.variables(group)

    def make(self, entries):
        text = cpp_doc(self.header, self.path)
        if not text:
            self.missing.append(f'{self.header.find("location").get("file")}:2: the header')
        self.intro, self.types = first_sentence(text) + "<br>", [cpp_name(entry) for entry in entries]
        self.add(text)
        self.add(f'<pre class="declaration"><code>#include &lt;vantage/{self.header.findtext("compoundname")}&gt;</code></pre>')
        self.list(entries, 2)
        self.finish()


def statements(file):
    """The number of the statement that each line of a header begins in: clang-format lets a declaration run over lines."""
    number, numbers = 0, []
    with open(os.path.join(ROOT, file), encoding="utf-8") as text:
        for line in text:
            code = re.sub(r"//.*", "", line)
            numbers.append(number)
            number += code.rstrip().endswith((";", "{", "}", ":"))
    return numbers


def cpp_pages():
    if not shutil.which("doxygen"):
        raise PluginError("doxygen is not installed (Debian: doxygen)")
    folder = os.path.join(ROOT, "build", "reference")
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    made = subprocess.run(["doxygen", "packaging/Doxyfile"], cwd=ROOT, capture_output=True, text=True, check=False)
    if made.returncode:
        raise PluginError(f"doxygen: {made.stderr}")
    compounds = [xml.parse(os.path.join(folder, "xml", name)).getroot().find("compounddef")
                 for name in sorted(os.listdir(os.path.join(folder, "xml"))) if name.endswith(".xml") and name not in ("index.xml", "Doxyfile.xml")]
    every = {compound.get("id"): compound for compound in compounds}
    headers = [compound for compound in compounds if compound.get("kind") == "file" and compound.findtext("compoundname") != "vantage.hpp"]
    found = []
    for header in headers:
        file = header.find("location").get("file")
        page, lines = CppPage(header, every), statements(file)
        types = [every[inner.get("refid")] for inner in header.findall("innerclass")]
        entries = [node for node in types if cpp_name(node).count("::") == 0]
        entries += [member for member in every["namespacevantage"].iter("memberdef")
                    if member.find("location").get("file") == file and is_public(member)]
        for node in types + entries:
            named = [node, *node.iter("memberdef")] if node.tag == "compounddef" else [node]
            for one in named:
                places[one.get("id")] = (page.path, cpp_name(one))
                one.set("statement", str(lines[line_of(one)[0] - 1]))
                for value in one.findall("enumvalue"):
                    places[value.get("id")] = (page.path, f'{cpp_name(one)}::{value.findtext("name")}')
        found.append((page, sorted(entries, key=line_of)))
    for node in compounds:  # what pages do not show is no place to go to
        for member in node.iter("memberdef"):
            if not is_public(member):
                places.pop(member.get("id"), None)
    for page, entries in found:
        page.make(entries)
    return [page for page, _ in found]


# --- Python ---

PARTS = {
    "Sites": "Error Site SiteChoice place_heads",
    "Scenes": "Scene MeshInfo Room SceneBuilder load_gltf built_in_scene_names write_built_in_scene",
    "Scanners and stations": "Scanner InstrumentErrors load_directions scanners Station StationSetup PlacedStation heads",
    "Ground": "SearchArea ClashChecker",
    "Simulation": "Simulator BeamOptions Scan write_point_cloud EngineInfo list_engines all_devices RayTracer RayHits",
    "Evaluation": "Evaluation RegistrationOptions RegistrationError Connectivity Target read_targets_csv UncoveredVoxels uncovered MissedVoxels why_missed",
    "On site": "OnSite OnSiteOptions Visit Round Session ClosedStation BatteryUse NextResult",
    "Plans": "PlanResult PlanEntry MeasuredValue PlanProgress",
    "Problems and objectives": "SurveyProblem coverage_fix coverage_overlap_fix coverage_min coverage_overlap_min fitness_min fewest_stations Objective "
                               "objective_names minimise maximise Scale Requirement MeasuredNetwork",
    "Choosing among candidates": "find_candidates Candidates SampledCoverage sample_coverage CoverageMatrix StationGraph overlap_graph CoverSolution max_cover "
                                 "min_cover StationsBound greedy improve_by_swaps min_connected_cover greedy_network GreedyResult exact_network ExactResult",
}


def installed_module():
    """The module of the environment, or the one that the tests installed."""
    sys.path.append(MODULE)
    try:
        return importlib.import_module("vantage")
    except ImportError as error:
        raise PluginError(f"the Python module is not installed ({error}): ctest --preset release -R python.install") from error
    finally:
        sys.path.remove(MODULE)


def text_html(text):
    """A docstring's sentences as HTML."""
    text = html.escape(re.sub(r"\s+", " ", text.strip()), quote=False)
    return re.sub(r"`+([^`]+)`+", r"<code>\1</code>", text)


def text_of(thing):
    """A docstring without the signature that pybind11 begins it with; the stubs have that in words of Python."""
    return re.sub(r"^\w+\(.*\) -> [^\n]*", "", inspect.cleandoc(getattr(thing, "__doc__", None) or "")).strip()


class PythonPage(Page):
    def __init__(self, title):
        super().__init__("python", re.sub(r"\W+", "_", title.lower()), title)

    def typed(self, node):
        """A type, with links to those of the module."""
        def linked(name):
            place = symbols["python"].get(name[0])
            return f'<a href="{link(self.path, place[0])}#{place[1]}">{name[0]}</a>' if place else name[0]
        text = ast.unparse(node)
        text = text if "Literal" in text else text.replace("'", "")  # of names that are defined further down
        return re.sub(r"\b[A-Z]\w+", linked, html.escape(text, quote=False))

    def sentences(self, text):
        text = errors_apart(f"<p>{text_html(text)}</p>")
        path, name = symbols["python"]["Error"]
        return text.replace("<strong>Raises</strong> Error", f'<strong>Raises</strong> <a href="{link(self.path, path)}#{name}">Error</a>')

    def doc(self, name, text, stub=None):
        """A docstring: paragraphs, and lists of options with their types and defaults."""
        if not text:
            self.missing.append(f"python: {name}")
        listed = re.split(r"(?m)^(\w[^\n]*):\n((?:    [^\n]*\n?)+)", text)
        for k, part in enumerate(listed):
            if k % 3 == 0 and part.strip():
                for paragraph in re.split(r"\n\s*\n", part.strip()):
                    self.add(self.sentences(paragraph))
            elif k % 3 == 1:
                self.add(f"<p><strong>{text_html(part)}:</strong></p>")
            elif k % 3 == 2:
                self.options(name, re.sub(r"\n {5,}", " ", part), stub)

    def options(self, name, lines, stub):
        types, defaults = {}, {}
        if stub is not None:
            types = {arg.arg: arg.annotation for arg in stub.args.args + stub.args.kwonlyargs if arg.annotation}
            defaults = {arg.arg: ast.unparse(value) for arg, value in zip(stub.args.kwonlyargs, stub.args.kw_defaults) if value}
        rows = []
        for option, form, text in re.findall(r"^ +(\w+)(?: \(([^)]*)\))?: (.*)$", lines, re.M):
            declaration = f"<b>{option}</b>"
            if form:
                declaration += f": {html.escape(form)}"
            elif option in types and ast.unparse(types[option]) != "Setting":
                declaration += f": {self.typed(types[option])}"
                if defaults.get(option, "...") != "...":
                    declaration += f" = {html.escape(defaults[option])}"
                    text = re.sub(r" Default: .*$", "", text)
            rows.append(([(f"{name}({option})", declaration)], text_html(text)))
        self.members(rows)

    def signature(self, name, stub, text):
        """Options that the docstring lists stand there."""
        listed = set(re.findall(r"(?m)^    (\w+)(?: \([^)]*\))?: ", text))
        every, parameters = stub.args, []
        defaults = dict(zip([arg.arg for arg in every.args][len(every.args) - len(every.defaults):], every.defaults))
        defaults |= {arg.arg: value for arg, value in zip(every.kwonlyargs, every.kw_defaults) if value}
        for arg in every.args + every.kwonlyargs:
            if arg.arg == "self" or arg.arg in listed:
                continue
            if arg in every.kwonlyargs and "*" not in parameters:
                parameters.append("*")
            default = f" = {html.escape(ast.unparse(defaults[arg.arg]))}" if arg.arg in defaults else ""
            parameters.append(arg.arg + (f": {self.typed(arg.annotation)}" if arg.annotation else "") + default)
        if listed & {arg.arg for arg in every.kwonlyargs}:
            parameters.append("**options")
        made = stub.name == "__init__" or not stub.returns
        self.add(call(name, parameters, after="" if made else f" -&gt; {self.typed(stub.returns)}"))

    def function(self, name, stub, text):
        self.signature(name, stub, text)
        self.doc(name, text, stub)

    def type(self, node, thing):
        name, attributes, methods, made = node.name, [], [], None
        self.heading(2, name, "class")
        for item in node.body:
            if isinstance(item, ast.AnnAssign):
                attributes.append((item.target.id, item.annotation))
            elif isinstance(item, ast.FunctionDef) and "property" in map(ast.unparse, item.decorator_list):
                attributes.append((item.name, item.returns))
            elif item.name == "__init__":
                made = item
            elif not item.name.startswith("__") and f"{item.name}.setter" not in map(ast.unparse, item.decorator_list):
                methods.append(item)
        if node.bases:
            self.add(f'<pre class="declaration"><code>class <b>{name}</b>({", ".join(map(self.typed, node.bases))})</code></pre>')
        if made and not text_of(thing.__init__):  # the class tells how it is made
            self.function(name, made, text_of(thing))
        else:
            self.doc(name, text_of(thing))
            if made:
                self.function(name, made, text_of(thing.__init__))
        told = text_of(thing)
        rows = [self.attribute(f"{name}.{attribute}", kind, getattr(thing, attribute)) for attribute, kind in attributes
                if name != "Error"  # whose docstring lists its own
                and f"    {attribute}: {text_of(getattr(thing, attribute))}" not in told]
        if len(rows) < len(attributes) and name != "Error":
            self.add("<p>Options are attributes, too.</p>")
        if rows:
            self.add("<p><strong>Attributes:</strong></p>")
            self.members(rows)
        for method in methods:
            self.heading(3, f"{name}.{method.name}")
            self.function(f"{name}.{method.name}", method, text_of(getattr(thing, method.name)))

    def attribute(self, name, kind, thing):
        text = text_of(thing)
        if not text:
            self.missing.append(f"python: {name}")
        return [(name, f"<b>{name.split('.')[1]}</b>: {self.typed(kind)}")], self.sentences(text)


def python_pages():
    module = installed_module()
    with open(os.path.join(ROOT, "python", "vantage", "__init__.pyi"), encoding="utf-8") as file:
        text = file.read()
    body, lines = ast.parse(text).body, text.split("\n")
    stubs = {node.name: node for node in body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    found = [(PythonPage(title), names.split()) for title, names in PARTS.items()]
    if sorted(stubs) != sorted(name for _, names in found for name in names):
        raise PluginError(f"PARTS of reference.py and the stubs differ: {set(stubs) ^ {name for _, names in found for name in names}}")
    symbols["python"] |= {name: (page.path, name) for page, names in found for name in names}
    first, aliases = found[0][0], [node for node in body if isinstance(node, ast.Assign)]
    symbols["python"] |= {node.targets[0].id: (first.path, node.targets[0].id) for node in aliases}
    for page, names in found:
        page.types = names
        for name in names:
            if isinstance(stubs[name], ast.ClassDef):
                page.type(stubs[name], getattr(module, name))
            else:
                page.heading(2, name)
                page.function(name, stubs[name], text_of(getattr(module, name)))
    first.add("## Types of arguments {: #types }")
    first.members([([(node.targets[0].id, f"<b>{node.targets[0].id}</b> = {first.typed(node.value)}")], text_html(lines[node.lineno - 2].lstrip("# ")))
                   for node in aliases])
    for page, _ in found:
        page.finish()
    return [page for page, _ in found]


# --- mkdocs ---

made = {}


def on_config(config):
    pages.clear()
    places.clear()
    symbols.update(cpp={}, python={})
    made["cpp"], made["python"] = cpp_pages(), python_pages()
    missing = [name for found in made.values() for page in found for name in page.missing]
    if missing:
        raise PluginError("without a comment or docstring:\n  " + "\n  ".join(missing))
    for path, text in pages.items():
        file = os.path.join(PAGES, path)
        os.makedirs(os.path.dirname(file), exist_ok=True)
        with open(file, "w", encoding="utf-8") as out:
            out.write(text)
    section = next(entry["Reference"] for entry in config["nav"] if "Reference" in entry)
    for language, name in (("python", "Python"), ("cpp", "C++")):
        section.append({name: [{page.title: page.path} for page in made[language]]})
    return config


def on_files(files, config):
    for path in pages:
        files.append(File(path, PAGES, config["site_dir"], config["use_directory_urls"]))
    return files


def on_page_markdown(markdown, page, **_):
    """The overview gets its tables."""
    if page.file.src_uri != "reference.md":
        return markdown
    for language, found in made.items():
        rows = "".join(f"| [{one.title}]({one.path}) | {one.intro}"
                       + ", ".join(f"[{name}]({one.path}#{name})" for name in dict.fromkeys(one.types) if not name.startswith("operator")) + " |\n" for one in found)
        markdown = markdown.replace(f"<!-- pages: {language} -->", "| page | contents |\n| --- | --- |\n" + rows)
    return markdown


def on_page_content(text, page, **_):
    """Names in code lead to their place in the reference: types, members, and functions with their brackets."""
    here = page.file.src_uri
    order = ("python", "cpp") if "python" in here else ("cpp", "python")

    def linked(code):
        name = re.sub(r"^vantage(?:::|\.)", "", code[1])
        if re.fullmatch(r"[A-Z]\w*[a-z]\w*|\w+(?:::|\.)[\w:.]+|[\w:.]+\(\)", name):
            for language in order:
                place = symbols[language].get(name.removesuffix("()"))
                if place:
                    return f'<a href="{link(here, place[0])}#{place[1]}">{code[0]}</a>'
        return code[0]

    return re.sub(r'(?<!">)<code>([\w:.]+(?:\(\))?)</code>', linked, text)
