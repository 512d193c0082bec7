"""Sphinx builds the site from the pages of this folder: ``make docs``."""

import re
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

import generate  # noqa: E402 - it lies beside this file

project = 'Shared-control trainer'
author = 'shared-control maintainers'
release = generate.version()
extensions = ['myst_parser', 'sphinx.ext.autodoc', 'sphinx.ext.napoleon', 'sphinxcontrib.mermaid']
exclude_patterns = ['README.md', '_build']  # README.md is what GitHub shows of this folder; index.md includes it
html_theme = 'furo'
html_title = f'{project} {release}'
myst_fence_as_directive = ['mermaid']
myst_heading_anchors = 3
autodoc_member_order = 'bysource'
autodoc_typehints = 'description'
autodoc_preserve_defaults = True
autodoc_mock_imports = ['rerun']  # an extra that documentation does not need
suppress_warnings = [
    'misc.highlighting_failure',  # shell lines with <placeholders>
    'ref.python',  # the annotation `type` beside attributes of that name
]

generate.write(HERE / 'reference' / 'generated')

TAKEN_OVER = {'index': HERE / 'README.md', 'changelog': HERE.parent / 'CHANGELOG.md'}
"""Pages that begin with a file which GitHub shows in another place."""


def _read(app, page, content):
    """Put in what a page takes over, and name files outside this folder, which are no pages of the site."""
    text, folder = content[0], (HERE / page).parent
    if page in TAKEN_OVER:
        source = TAKEN_OVER[page]
        text = source.read_text() + text
        if source.parent != HERE:  # its links begin at the repository's root
            text = re.sub(r'\]\((?!\w+:)(docs/)?', lambda link: '](' if link[1] else '](../', text)
        text = text.replace('](../CHANGELOG.md)', '](changelog.md)')

    def named(link):
        target = (folder / link[2]).resolve()
        return link[0] if target.is_relative_to(HERE) else f'{link[1]} (`{target.relative_to(HERE.parent)}`)'

    content[0] = re.sub(r'\[([^\]]*)\]\(([^)#:]+)(?:#[^)]*)?\)', named, text)


def _bars(app, what, name, thing, options, lines):
    """Let ``|e|`` in docstrings be a magnitude, and no substitution of reStructuredText."""
    lines[:] = [re.sub(r'(``.*?``)|\|', lambda found: found[1] or r'\|', line) for line in lines]


def setup(app):
    """As Sphinx calls it."""
    app.connect('source-read', _read)
    app.connect('autodoc-process-docstring', _bars)
