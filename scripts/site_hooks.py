# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Hooks of MkDocs (mkdocs.yml).

Links in our Markdown are paths in the repository, as GitHub follows them. The site has docs/ and some pages from
elsewhere; links to other files of the repository become their paths in text. Anchors are named as on GitHub. After the
build, all internal links of the pages are followed, anchors included. A broken link is a warning, which --strict turns
into an error.
"""
import logging
import posixpath
import re
from html.parser import HTMLParser
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from urllib.parse import unquote, urldefrag

from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parent.parent
PAGES_FROM_ELSEWHERE = ("CHANGELOG.md", "CONTRIBUTING.md", "bench/README.md", "scenes/README.md")
NOT_FOR_READERS = ("figures.json",)  # and scripts that make figures
LINK = re.compile(r"(?<!!)\[((?:[^\[\]]|!\[[^\]]*\]\([^)]*\))*)\]\(([^)\s]+)\)")
logger = logging.getLogger("mkdocs.hooks.lanthorn")


def load(script):
    loader = SourceFileLoader(script.replace("-", "_"), str(ROOT / "scripts" / script))
    module = module_from_spec(spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


check_markdown = load("check-markdown")


def on_config(config):
    config["mdx_configs"]["toc"]["slugify"] = lambda text, separator: check_markdown.slug(text)
    return config


def on_files(files, config):
    for file in list(files):
        if file.name.startswith("make-") or file.src_path in NOT_FOR_READERS:
            files.remove(file)
    for page in PAGES_FROM_ELSEWHERE:
        files.append(File(page, str(ROOT), config["site_dir"], config["use_directory_urls"]))
    return files


def site_path(repository_path):
    """Where a file of the repository is in the site; None if it is not."""
    if repository_path in PAGES_FROM_ELSEWHERE:
        return repository_path
    if repository_path == "README.md":
        return "index.md"
    return repository_path[len("docs/"):] if repository_path.startswith("docs/") else None


def on_page_markdown(markdown, page, config, files):
    source = page.file.src_path
    folder = posixpath.dirname(source if source in PAGES_FROM_ELSEWHERE else "docs/" + source)

    def followed(match):
        text, target = match.groups()
        if re.match(r"[a-z]+:|#", target):
            return match[0]
        path, anchor = urldefrag(target)
        path = posixpath.normpath(posixpath.join(folder, path))
        here = site_path(path)
        if here is not None and (ROOT / path).is_dir():
            here = posixpath.join(here, "README.md")
        if here is not None and files.get_file_from_path(here):
            return f"[{text}]({posixpath.relpath(here, posixpath.dirname(source) or '.')}{'#' + anchor if anchor else ''})"
        if not (ROOT / path).exists():
            logger.warning("%s: dead link: %s", source, target)
        return text if posixpath.splitext(posixpath.basename(path))[0] in text else f"{text} (`{path}`)"

    lines = markdown.split("\n")
    return "\n".join(line if code else LINK.sub(followed, line) for line, code in zip(lines, check_markdown.code_lines(lines)))


def on_nav(nav, config, files):
    named = {page.file.src_path for page in nav.pages}
    for file in files.documentation_pages():
        if file.src_path not in named:
            logger.warning("%s: the navigation in mkdocs.yml does not name this page", file.src_path)
    return nav


class Page(HTMLParser):
    """Anchors, links and resources of a page."""

    def __init__(self, text):
        super().__init__()
        self.anchors, self.links, self.resources = set(), [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        named = dict(attributes)
        self.anchors.update(value for key, value in attributes if key in ("id", "name") and value)
        if tag == "a" and named.get("href"):
            self.links.append(named["href"])
        source = named.get("src") or (named.get("href") if tag == "link" and named.get("rel") != "canonical" else None)
        if source:
            self.resources.append(source)


def on_post_build(config):
    site = Path(config["site_dir"])
    pages = {path.relative_to(site).as_posix(): Page(path.read_text()) for path in site.rglob("*.html")}
    for name, page in pages.items():
        if name == "404.html":  # its links begin at the root of a server
            continue
        for target in page.resources:
            if re.match(r"(https?:)?//", target):
                logger.warning("%s loads %s from another host", name, target)
        for target in page.links + page.resources:
            if re.match(r"[a-z]+:|//", target):
                continue
            path, anchor = urldefrag(unquote(target))
            path = posixpath.normpath(posixpath.join(posixpath.dirname(name), path)) if path else name
            if not (site / path).exists() or (anchor and path in pages and anchor not in pages[path].anchors):
                logger.warning("%s: dead link: %s", name, target)
