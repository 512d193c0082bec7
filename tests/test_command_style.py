"""One style of help for commands and scripts: plain text, defaults shown, examples that work, one name for a thing."""

import argparse
import importlib.util
import re
import shlex
import sys
from collections import defaultdict
from pathlib import Path

import pytest
from shared_control.cli import known_commands
from shared_control.command_line import EXAMPLES, add_json_option, add_parser, make_parser, write_json

DIFFERENT = {
    '--output': ('FOLDER', 'PATH', 'FILE'),  # what is written differs: a folder, or one file
}
"""Metavars of options that may differ between commands."""


ROOT = Path(__file__).parents[1]
SCRIPTS = [path for folder in ('benchmarks', 'tools') for path in sorted((ROOT / folder).glob('*.py'))
           if 'parse_args' in path.read_text()]


def subcommands():
    subparsers = argparse.ArgumentParser(prog='shared-control').add_subparsers()
    for entry_point in known_commands():
        entry_point.load()(subparsers)
    return dict(subparsers.choices)


PARSERS = subcommands()
OPTIONS = [pytest.param(parser, action, id=f'{name} {[*action.option_strings, action.dest][0]}')
           for name, parser in PARSERS.items() for action in parser._actions]


def test_all_commands_are_there():
    assert {'session', 'replay', 'train', 'evaluate', 'study', 'doctor'} <= PARSERS.keys()


@pytest.mark.parametrize(('parser', 'action'), OPTIONS)
def test_an_option_has_help_and_shows_its_default(parser, action):
    assert action.help and not action.help.endswith('.')
    takes_a_value = action.nargs != 0 and action.option_strings
    if takes_a_value:
        assert '(default: ' in parser._get_formatter()._expand_help(action), action.option_strings
        assert action.choices or (action.metavar or '').isupper(), 'a metavar'
    elif not action.option_strings:
        assert action.metavar and action.metavar.isupper()


@pytest.mark.parametrize(('parser', 'action'), [case for case in OPTIONS if case.values[1].type is Path])
def test_an_empty_path_is_refused(parser, action, capsys):
    given = [action.option_strings[0], ''] if action.option_strings else ['']
    with pytest.raises(SystemExit):
        parser.parse_args(given)
    assert 'the path is empty' in capsys.readouterr().err


@pytest.mark.parametrize('name', PARSERS)
def test_help_is_plain_text_of_this_product(name):
    text = PARSERS[name].format_help()
    assert not re.search(r'``|`|\*\*|:\w+:`|SUPPRESS|None', text)
    assert sys.prefix not in text, 'no path of this machine'
    assert not re.search(r'\(\d\.\d\)', text), 'no number of a section without the book'
    assert '--version' in text


@pytest.mark.parametrize('name', PARSERS)
def test_examples_parse(name):
    first, *lines = PARSERS[name].epilog.splitlines()
    assert first == EXAMPLES and lines
    assert any(line.split()[1] == name for line in lines), 'an example of this command'
    for line in lines:
        program, command, *arguments = shlex.split(line)
        assert program == 'shared-control'
        assert PARSERS[command].parse_args(arguments).run


class _Asked(Exception):
    """A script has made its parser."""


def parser_of(script, monkeypatch):
    """The parser of a script that is run by its path."""
    def ask(parser, *_):
        raise _Asked(parser)
    monkeypatch.syspath_prepend(script.parent)
    spec = importlib.util.spec_from_file_location(f'script_{script.stem}', script)
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, spec.name, module)
    spec.loader.exec_module(module)
    with monkeypatch.context() as patch:
        patch.setattr(argparse.ArgumentParser, 'parse_args', ask)
        with pytest.raises(_Asked) as asked:
            module.main()
    return asked.value.args[0]


@pytest.mark.parametrize('script', SCRIPTS, ids=lambda path: path.stem)
def test_a_script_has_the_same_style(script, monkeypatch):
    parser = parser_of(script, monkeypatch)
    for action in parser._actions:
        test_an_option_has_help_and_shows_its_default(parser, action)
    assert not re.search(r'``|`|SUPPRESS|None', parser.format_help())
    first, *lines = parser.epilog.splitlines()
    assert first == EXAMPLES and lines
    for line in lines:
        _, called, arguments = line.partition(f'python {script.relative_to(ROOT)}')
        if called:
            parser.parse_args(shlex.split(arguments, comments=True))
    assert any(str(script.relative_to(ROOT)) in line for line in lines)


def test_one_name_means_one_thing():
    metavars, destinations = defaultdict(set), defaultdict(set)
    for parser in PARSERS.values():
        for action in parser._actions:
            for option in action.option_strings:
                metavars[option].add(action.metavar)
            if action.option_strings and action.nargs != 0:
                destinations[action.dest].add(action.option_strings[-1])
    assert {option: names for option, names in metavars.items()
            if len(names) > 1 and not names <= {*DIFFERENT.get(option, ())}} == {}
    assert {name: options for name, options in destinations.items() if len(options) > 1} == {}
    # The options that were called otherwise somewhere: --output, --test-episodes, --workers.
    assert not {'--out', '--folder', '--dir', '--save', '--file', '--jobs', '--random-seed', '--fast'} & metavars.keys()


def test_the_style_shows_a_default_of_zero_and_no_default_of_a_flag():
    parser = make_parser('What it does.\n\n  kept   as it is', ['it --number 3'], prog='it')
    parser.add_argument('--number', type=int, default=0, metavar='N', help='how many')
    parser.add_argument('--flag', action='store_true', help='do it')
    text = parser.format_help()
    assert '(default: 0)' in text and 'do it\n' in text and '  kept   as it is' in text and EXAMPLES in text


def test_json_goes_to_a_file_or_to_the_output(tmp_path, capsys):
    commands = argparse.ArgumentParser().add_subparsers()
    parser = add_parser(commands, 'x', lambda _: 0, summary='x', description='x', examples=['x'])
    add_json_option(parser, 'all')
    write_json({'a': 1}, parser.parse_args(['--json', str(tmp_path / 'new' / 'x.json')]).json)
    assert (tmp_path / 'new' / 'x.json').read_text() == '{\n  "a": 1\n}\n' and capsys.readouterr().out == ''
    write_json({'a': 1}, parser.parse_args(['--json', '-']).json)
    assert capsys.readouterr().out == '{\n  "a": 1\n}\n'
    write_json({'a': 1}, parser.parse_args([]).json)
    assert capsys.readouterr().out == ''
