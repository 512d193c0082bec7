"""The pictures of the packages in docs/explanation/architecture.md follow the rules of import in pyproject.toml."""

import itertools
import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
CONTRACTS = tomllib.loads((ROOT / 'pyproject.toml').read_text())['tool']['importlinter']['contracts']
LAYERS = [contract for contract in CONTRACTS if contract['type'] == 'layers']
PAGE = (ROOT / 'docs' / 'explanation' / 'architecture.md').read_text()


def short(module):
    """The name of a module in a picture."""
    return module.rpartition('.')[2]


def layers_of(contract):
    """The modules of each layer, top layer first."""
    return [[short(module) for module in re.split(r'[|:]', layer.replace(' ', ''))] for layer in contract['layers']]


def drawn(contract):
    """The arrows of the picture of a contract as pairs of modules; the modules that it shows."""
    blocks = [block for block in re.findall(r'```mermaid\n(.*?)```', PAGE, re.DOTALL)
              if f'%% rules: {contract["name"]}\n' in block]
    assert len(blocks) == 1, f'pictures of {contract["name"]!r}'
    known = set(itertools.chain(*layers_of(contract)))
    members, arrows = {}, []
    for line in blocks[0].splitlines():
        if line.strip().startswith(('flowchart', '%%')):
            continue
        for node, label in re.findall(r'(\w+)\["(.+?)"\]', line):
            members[node] = [name for name in re.findall(r'\w+', label.replace('<br/>', ' ')) if name in known]
        groups = [re.findall(r'\w+', group) for group in re.sub(r'\[".+?"\]', '', line).split('-->')]
        for node in itertools.chain(*groups):
            members.setdefault(node, [node])
        arrows += [pair for left, right in itertools.pairwise(groups) for pair in itertools.product(left, right)]
    shown = list(itertools.chain(*members.values()))
    return {pair for left, right in arrows for pair in itertools.product(members[left], members[right])}, shown


def reachable(arrows):
    """Pairs of modules between which there is a way along arrows."""
    found = set(arrows)
    while more := {(a, d) for a, b in found for c, d in found if b == c} - found:
        found |= more
    return found


def allowed(contract, imports):
    """Pairs that all contracts together allow, where ``imports`` are the ways that there are."""
    layers = layers_of(contract)
    pairs = {pair for above, below in itertools.combinations(layers, 2) for pair in itertools.product(above, below)}
    for other in CONTRACTS:
        if other['type'] == 'forbidden':
            # Forbidden in a roundabout way, too: neither for these modules nor for what they import.
            sources = {short(module) for module in other['source_modules']}
            sources |= {below for above, below in imports if above in sources}
            pairs -= set(itertools.product(sources, other['forbidden_modules']))
    return pairs


@pytest.mark.parametrize('contract', LAYERS, ids=lambda contract: contract['name'])
def test_a_picture_shows_every_module_once(contract):
    assert sorted(drawn(contract)[1]) == sorted(itertools.chain(*layers_of(contract)))


@pytest.mark.parametrize('contract', LAYERS, ids=lambda contract: contract['name'])
def test_a_picture_allows_what_the_rules_allow(contract):
    ways = reachable(drawn(contract)[0])
    assert ways == allowed(contract, ways)
