#!/usr/bin/env python3
"""Checks that the documentation speaks of what is there.

usage: check_docs.py ROOT

Reads README.md, docs/*.md and the comments of all sources. Prints one line for each breach and exits with 1 if there is
any:
- a document names, in backquotes or as the target of a link, a file or folder that does not exist. A path is told from
  other words by a `/` or a source's extension; it starts at ROOT, at the document, at host/ or at the module's folder.
  `{h,cpp}` stands for both, `*` for anything.
- a document names a function or type as `path: name` or `path: name, name` that the file does not hold, or a member
  `Class::member` that no source holds;
- a command-line option, a field of --stats or a benchmark is not told in its document;
- a source or document points at a section ("docs/architecture.md, A tile") that the document does not have.
"""
import itertools
import re
import sys
from pathlib import Path

STARTS = ["", "host", "modules/globebrowsing", "modules"]
EXTENSIONS = "h cpp in py glsl vert frag md txt asset cmake json sh osrectxt".split()
CODE = re.compile(r"`([^`]+)`")
MEMBER = re.compile(r"\w+(?:::\w+)+(?:\(\))?")
LINK = re.compile(r"\]\(([^)#\s]+)\)")
FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
PATH = re.compile(r"[\w.*{},+-]+(?:/[\w.*{},+-]+)*/?")
SECTION = re.compile(r"(docs/[\w-]+\.md),\s+(?:///?\s+|#\s+)?([A-Z][\w ]*\w)")
# Folders that programs make, and what lies outside of the tree.
ELSEWHERE = re.compile(r"^(build|out|/|~|-)")
# What must be told: where it is declared, how, and in which document.
TOLD = [
    ("host/app/options.cpp", re.compile(r'(?:add_option|add_flag)\("(?:-\w,)?(--[a-z-]+)"'), "docs/command-line.md"),
    ("host/app/statistics_report.cpp", re.compile(r'(?:\{|report\[)"([a-z0-9_]+)"'), "docs/command-line.md"),
    ("scripts/lib/benchmarks/*.py", re.compile(r'^@benchmark\("([\w-]+)"', re.MULTILINE), "docs/benchmarks.md"),
]
SOURCES = {".h", ".cpp", ".py", ".glsl", ".vert", ".frag", ".cmake", ".md", ".txt"}


def looks_like_path(text):
    """Whether the words in backquotes are meant as a path of the tree."""
    if not PATH.fullmatch(text) or ELSEWHERE.match(text):
        return False
    name = text.rstrip("/").rsplit("/", 1)[-1]
    extension = name.rsplit(".", 1)[-1] if "." in name else ""
    known = extension in EXTENSIONS or extension.startswith("{")
    return known or text.endswith("/") or ("/" in text and text.split("/")[0] in
                                           ("host", "modules", "globebrowsing", "shaders", "scripts", "tests", "data",
                                            "docs", "cmake"))


def expanded(text):
    """The paths that `a.{h,cpp}` stands for."""
    parts = re.split(r"\{([^}]*)\}", text)
    choices = [part.split(",") if i % 2 else [part] for i, part in enumerate(parts)]
    return ["".join(chosen) for chosen in itertools.product(*choices)]


def find(root, document, path):
    """The file or folder that a document means, or None."""
    for start in [*(root / start for start in STARTS), document.parent]:
        found = next(iter(sorted(start.glob(path.rstrip("/")))), None) if "*" in path else start / path
        if found is not None and found.exists():
            return found
    return None


def holds(text, name):
    """Whether a source's text has the last word of `A::b()`."""
    last = name.removesuffix("()").rsplit("::", 1)[-1]
    return re.search(rf"\b{re.escape(last)}\b", text) is not None


def mentions(text):
    """What stands in backquotes or is linked to, and in which line."""
    text = FENCE.sub(lambda match: "\n" * match.group().count("\n"), text)
    line = 1
    for paragraph in re.split(r"(\n\n)", text):
        for match in [*CODE.finditer(paragraph), *LINK.finditer(paragraph)]:
            yield " ".join(match.group(1).split()), line + paragraph.count("\n", 0, match.start())
        line += paragraph.count("\n")


def check_document(root, document, sources):
    """Breaches in one document's paths and names."""
    breaches = []
    for mention, line in mentions(document.read_text()):
        place = f"{document.relative_to(root).as_posix()}:{line}"
        if MEMBER.fullmatch(mention):
            if not any(holds(text, mention) for text in sources):
                breaches.append(f"{place}: no source holds {mention}")
            continue
        path, _, names = mention.partition(": ")
        if not looks_like_path(path):
            continue
        files = [find(root, document, one) for one in expanded(path)]
        if None in files:
            breaches.append(f"{place}: {path} does not exist")
            continue
        for name in filter(None, (word.strip() for word in names.split(","))):
            if not any(holds(file.read_text(), name) for file in files if file.is_file()):
                breaches.append(f"{place}: {path} holds no {name}")
    return breaches


def headings(document):
    """Titles of a document's sections."""
    return {line.lstrip("#").strip() for line in FENCE.sub("", document.read_text()).splitlines()
            if line.startswith("#")}


def check_sections(root):
    """Breaches in references to sections."""
    breaches = []
    for top in ("host", "modules", "shaders", "scripts", "tests", "cmake", "docs", "README.md"):
        files = [root / top] if (root / top).is_file() else sorted((root / top).rglob("*"))
        for file in files:
            if file.name.startswith("check_docs") or not file.is_file():
                continue
            if file.suffix not in SOURCES and file.suffix != "":
                continue
            text = file.read_text(errors="replace")
            for match in SECTION.finditer(text):
                document = root / match.group(1)
                title = match.group(2)
                if not document.exists() or not any(title == heading or title.startswith(heading + " ")
                                                    for heading in headings(document)):
                    place = f"{file.relative_to(root).as_posix()}:{text.count(chr(10), 0, match.start()) + 1}"
                    breaches.append(f"{place}: {match.group(1)} has no section {title}")
    return breaches


def check_told(root):
    """Breaches in what a document must tell."""
    breaches = []
    for sources, declaration, document in TOLD:
        told = [mention for mention, _ in mentions((root / document).read_text())] if (root / document).exists() else []
        for file in sorted(root.glob(sources)):
            breaches += [f"{document}: does not tell of {name}, which {file.relative_to(root).as_posix()} declares"
                         for name in declaration.findall(file.read_text())
                         if not any(re.search(rf"(?<![\w-]){re.escape(name)}(?![\w-])", mention) for mention in told)]
    return breaches


def check(root):
    """All breaches in the tree below `root`."""
    documents = [root / "README.md", *sorted((root / "docs").glob("*.md"))]
    sources = [file.read_text(errors="replace") for top in ("host", "modules") for file in (root / top).rglob("*")
               if file.suffix in (".h", ".cpp")]
    breaches = [breach for document in documents if document.exists()
                for breach in check_document(root, document, sources)]
    return breaches + check_told(root) + check_sections(root)


def main():
    if len(sys.argv) != 2:
        print("usage: check_docs.py ROOT", file=sys.stderr)
        return 2
    root = Path(sys.argv[1]).resolve()
    if not (root / "docs").is_dir():
        print(f"{root}: no such tree; name the folder that holds docs/", file=sys.stderr)
        return 2
    breaches = check(root)
    print("\n".join(breaches) if breaches else "the documents speak of what is there")
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main())
