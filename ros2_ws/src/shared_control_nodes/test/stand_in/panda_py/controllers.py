"""Stands in for panda_py.controllers."""


class AppliedTorque:
    """As panda_py.controllers.AppliedTorque."""

    def set_control(self, torque):
        self.torque = torque.copy()
