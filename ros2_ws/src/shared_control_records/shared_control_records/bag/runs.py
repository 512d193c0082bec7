"""When the robot's time ran on, and when it was set back: by a simulator that was started anew, or by a clock."""

import numpy as np

from .reader import Bag


def run_window(bag: Bag, received_ns: int) -> tuple[int, int]:
    """The recorder's time from which, and until which, the robot's time ran on around ``received_ns``, ns.

    Stamps are in order there and name one moment each. Beyond, the same stamps may come again, of another run.
    """
    stamps, received = bag.joint_states.stamp_ns, bag.joint_states.received_ns
    set_back = received[1:][np.diff(stamps) < 0]
    index = int(np.searchsorted(set_back, received_ns, 'right'))
    limits = np.iinfo(np.int64)
    return (int(set_back[index - 1]) if index else limits.min,
            int(set_back[index]) if index < len(set_back) else limits.max)
