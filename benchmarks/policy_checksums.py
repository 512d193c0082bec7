"""Whether a change left learning as it was, to the bit: checksums of policies after three episodes.

    python benchmarks/policy_checksums.py            # compares with policy_checksums.json; exit code 1 on a difference
    python benchmarks/policy_checksums.py --write    # records them anew

Bits are the same only with the pinned libraries on the same kind of processor.
"""

import hashlib
import json
import sys
from pathlib import Path

from shared_control.command_line import script_parser
from shared_control.teaching.profiles import profile
from shared_control_learning.policy_file import load_policy
from shared_control_learning.presets import preset
from shared_control_learning.training import train

RECORDED = Path(__file__).with_suffix('.json')
EPISODES = 3
SEEDS = range(3)
TUTORS = {'coached': 'expert', 'autonomous': None}


def checksum(preset_name: str, tutor: str | None, seed: int, folder: Path) -> str:
    """SHA-256 of the weights after three episodes, in the order of their names."""
    train(preset(preset_name), None if tutor is None else profile(tutor), seed, EPISODES, evaluate_every=0,
          folder=folder)
    weights = load_policy(folder / 'policy.safetensors').policy.state_dict()
    return hashlib.sha256(b''.join(weights[name].numpy().tobytes() for name in sorted(weights))).hexdigest()


def main() -> int:
    """Entry point."""
    parser = script_parser(__doc__)
    parser.add_argument('--write', action='store_true', help='record them instead of comparing')
    args = parser.parse_args()
    import tempfile
    with tempfile.TemporaryDirectory() as folder:
        found = {f'{name} {seed}': checksum(name, tutor, seed, Path(folder) / f'{name}{seed}')
                 for name, tutor in TUTORS.items() for seed in SEEDS}
    if args.write:
        RECORDED.write_text(json.dumps(found, indent=2) + '\n')
        return 0
    recorded = json.loads(RECORDED.read_text())
    for name, value in found.items():
        print(f'{name:14} {value[:16]} {"same" if recorded.get(name) == value else "DIFFERENT"}')
    return int(found != recorded)


if __name__ == '__main__':
    sys.exit(main())
