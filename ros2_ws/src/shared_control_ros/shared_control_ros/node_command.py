"""The command of a node: its help at once, and everything else from its module."""

import ast
import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path


def run_node(module: str) -> int:
    """``main()`` of the module, or its docstring for ``--help``: read from its file, since to import it takes a second.

    Returns: the exit code.
    """
    if {'-h', '--help'} & set(sys.argv[1:]):
        spec = find_spec(module)
        assert spec is not None and spec.origin is not None, module
        print(ast.get_docstring(ast.parse(Path(spec.origin).read_text())))
        print('\nParameters: --ros-args -p NAME:=VALUE or --ros-args --params-file FILE; the README lists them.')
        return 0
    return import_module(module).main()
