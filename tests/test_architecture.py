"""The picture of the code in docs/architecture.md is that of the rules of import."""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]


def test_the_picture_shows_the_layers_that_are_checked():
    contracts = tomllib.loads((ROOT / 'pyproject.toml').read_text())['tool']['importlinter']['contracts']
    layers = [re.split(r'\W+', layer) for layer in contracts[0]['layers']]
    page = (ROOT / 'docs' / 'architecture.md').read_text()
    picture = re.findall(r'```mermaid\nflowchart TD\n(.*?)```', page, re.DOTALL)[0]
    groups = {name: re.findall(r'\w+', body) for name, body in re.findall(
        r'subgraph (\w+) \[" "\]\n(.*?)\n    end', picture, re.DOTALL)}
    arrows = re.findall(r'^    (\w+) --> (\w+)$', picture, re.MULTILINE)
    rows = [arrows[0][0], *(below for _, below in arrows)]
    assert [above for above, _ in arrows] == rows[:-1], 'one row below the other'
    assert [groups.get(row, [row]) for row in rows] == layers


def test_the_table_of_packages_is_complete():
    page = (ROOT / 'docs' / 'architecture.md').read_text()
    table = page[page.index('## Packages'):page.index('## Where a change goes')]
    packages = {path.parent.name for path in (ROOT / 'ros2_ws' / 'src').glob('*/package.xml')}
    assert packages <= set(re.findall(r'`(\w+)`', table))
