#!/usr/bin/env python3
"""The parts of tools/docs that are not shell:

    site.py files FOLDER        copies into FOLDER the files that its pages link to, and their links in turn
    site.py configure FILE      writes the configuration of MkDocs
    site.py interface FILE      writes a page of the C interface from its header
    site.py check FOLDER        follows every link of the built site, also to headings; status 1: a dead link

The pages are in the order of docs/README.md, which names every page.
"""
import html.parser
import json
import pathlib
import re
import shutil
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[1]
C_INTERFACE = "reference/c_interface.md"
SECTIONS = ("guide", "reference", "design")


def navigation(pages):
    index = (ROOT / "docs/README.md").read_text()
    paths = list(dict.fromkeys(re.findall(r"\]\(((?:%s)/[a-z0-9_-]+\.md)" % "|".join(SECTIONS), index, re.I)))
    paths.append(C_INTERFACE)
    notes = [
        f"lab/{path}"
        for path in re.findall(r"\]\((notes/[a-z0-9_-]+\.md)\)", (ROOT / "lab/README.md").read_text())]
    sections = [
        {name.capitalize(): [f"docs/{path}" for path in paths if path.startswith(name + "/")]}
        for name in SECTIONS]
    play = [{"Play": "play.md"}] if (pages / "play.md").exists() else []
    return [{"carom": "README.md"}, *play, {"Documents": "docs/README.md"}, *sections,
            {"Laboratory": ["lab/README.md", *notes]}, {"Contributing": "CONTRIBUTING.md"},
            {"What is asserted": "tests/README.md"}, {"Changes": "CHANGELOG.md"}, {"Security": "SECURITY.md"}]


def files(folder):
    """Links between pages and sources then work as in the repository, whose folders are kept."""
    folder = pathlib.Path(folder).resolve()
    pages = list(folder.rglob("*.md"))
    for page in pages:
        for link in re.findall(r"\]\(([^)#:\s]+)", page.read_text()):
            copy = (page.parent / link).resolve()
            if copy.exists() or not copy.is_relative_to(folder):
                continue
            source = ROOT / copy.relative_to(folder)
            if source.is_file():
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(source, copy)
                if copy.suffix == ".md":
                    pages.append(copy)


def configure(path):
    # JSON is valid YAML. Without fonts and icons from elsewhere, the site works offline.
    pathlib.Path(path).write_text(json.dumps({
        "site_name": "carom",
        "docs_dir": "pages",
        "nav": navigation(pathlib.Path(path).parent / "pages"),
        "use_directory_urls": False,
        "theme": {"name": "material", "font": False,
                  "features": ["navigation.sections", "navigation.top", "search.highlight"]},
        "plugins": ["search"],
        "markdown_extensions": ["tables", "fenced_code", "sane_lists", {"toc": {"permalink": True}}],
    }, indent=1))


def interface(path):
    """One heading for each part of the header, followed by the header's text."""
    header = (ROOT / "capi/include/carom/carom.h").read_text()
    parts = re.split(r"/\* ---- (.*?) ---- \*/\n", header)
    text = ("# The C interface\n\nThe header `carom/carom.h`, part by part. "
            "For an introduction, read [carom in your program](../guide/embedding.md).\n")
    for title, body in zip(["First"] + parts[1::2], parts[0::2]):
        text += f"\n## {title}\n\n```c\n{body.strip()}\n```\n"
    pathlib.Path(path).write_text(text)


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.anchors = [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for key, value in attributes:
            if key == "id":
                self.anchors.add(value)
            elif value and (key, tag) in (("href", "a"), ("src", "img")):
                self.links.append(value)


def check(folder):
    root = pathlib.Path(folder).resolve()
    pages = {path: Page(path.read_text()) for path in root.rglob("*.html") if path.name != "404.html"}
    dead = set()
    for path, page in pages.items():
        for link in page.links:
            url = urllib.parse.urlsplit(link)
            if url.scheme or url.netloc or link == "#":
                continue
            target = (path.parent / urllib.parse.unquote(url.path)).resolve() if url.path else path
            if target.is_dir():
                target /= "index.html"
            if not target.is_file() or (
                url.fragment and target in pages and url.fragment not in pages[target].anchors
            ):
                dead.add(f"{path.relative_to(root)}: {link}")
    for line in sorted(dead):
        print(f"site: dead link in {line}", file=sys.stderr)
    links = sum(len(page.links) for page in pages.values())
    print(f"site: {len(pages)} pages, {links} links: {folder}/index.html")
    return 1 if dead else 0


if __name__ == "__main__":
    commands = {"files": files, "configure": configure, "interface": interface, "check": check}
    if len(sys.argv) != 3 or sys.argv[1] not in commands:
        sys.exit(__doc__)
    sys.exit(commands[sys.argv[1]](sys.argv[2]))
