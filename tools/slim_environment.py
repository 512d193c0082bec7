"""Makes the environment of a Python smaller by what nothing needs at run time: 594 MB of the controller become 358.

    .venv/bin/python tools/slim_environment.py

C++ headers that pinocchio's wheels bring along (cmeel.prefix/include) are removed. Shared libraries that lie in one
folder under several names, since a wheel cannot hold links, become hard links of one file. Only what pip has
installed into this environment is touched, and pip takes it as it is: check, uninstall and upgrade work. An upgrade
brings new files; run it again then. Needs nothing but Python, so that an image can run it in the step that installs.
"""

import hashlib
import os
import shutil
import sys
import sysconfig
from collections import defaultdict
from importlib.metadata import distributions
from pathlib import Path


def remove_headers() -> int:
    """Remove the folder of headers; the bytes of its files."""
    folder = Path(sysconfig.get_path('platlib')) / 'cmeel.prefix' / 'include'
    freed = sum(path.stat().st_size for path in folder.rglob('*') if path.is_file())
    if folder.is_dir():
        shutil.rmtree(folder)
    return freed


def libraries() -> list[Path]:
    """Shared libraries that pip has installed into this environment, and into none below it."""
    files = (Path(os.path.normpath(distribution.locate_file(file)))
             for distribution in distributions() for file in distribution.files or () if '.so' in file.name)
    return sorted({path for path in files if path.is_relative_to(sys.prefix) and path.is_file()
                   and not path.is_symlink()})


def link_equal_libraries() -> int:
    """Leave one file of those that are equal and in one folder; the bytes that the others took."""
    alike: dict[tuple[Path, int], list[Path]] = defaultdict(list)
    for path in libraries():
        alike[path.parent, path.stat().st_size].append(path)
    freed = 0
    for paths in alike.values():
        known: dict[bytes, Path] = {}
        for path in paths if len(paths) > 1 else ():
            first = known.setdefault(hashlib.sha256(path.read_bytes()).digest(), path)
            if not path.samefile(first):
                link = path.with_name(f'{path.name}.linked')
                link.hardlink_to(first)
                link.replace(path)
                freed += first.stat().st_size
    return freed


def main() -> None:
    """Entry point."""
    if sys.argv[1:]:  # it has no options: whoever asks for help gets it, and nothing is touched
        raise SystemExit(__doc__)
    removed, linked = remove_headers(), link_equal_libraries()
    print(f'{sys.prefix}: {removed / 1e6:.0f} MB of headers removed, {linked / 1e6:.0f} MB of libraries linked')


if __name__ == '__main__':
    main()
