"""A node that cannot do anything without another says so, and goes on when that one comes."""

from shared_control_ros import contract

NEEDS = {
    'torque_ctrl_node': '/joint_states',
    'teleop_key_node': '/clock',
    'sim_tutor_node': '/ball',
    'robot_view_node': '/ball',
}


def test_nodes_say_what_they_cannot_do_without(observer, start_node):
    heard = observer.listen(contract.DIAGNOSTICS)

    def complain():
        newest = {status.name: status.message for message in heard for status in message.status}
        return [name for name, topic in NEEDS.items() if f'{topic}: has had no publisher' in newest.get(f'/{name}', '')]

    nodes = [start_node(package, use_sim_time=True) for package in NEEDS]
    for node, topic in zip(nodes, NEEDS.values(), strict=True):
        node.wait_for_log(f'{topic} has had no publisher')
    observer.spin(lambda: complain() == list(NEEDS))
    start_node('panda_sim_node', use_sim_time=True)
    observer.spin(lambda: not complain())
