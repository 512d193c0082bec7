from setuptools import find_packages, setup

package_name = 'shared_control_nodes'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    package_data={'shared_control_nodes': ['py.typed']},
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['panda_tray_description', 'shared_control', 'shared_control_ros', 'rclpy', 'numpy'],
    extras_require={'test': ['pytest'], 'panda': ['panda-python==1.1.1']},
    zip_safe=False,
    maintainer='shared-control maintainers',
    maintainer_email='maintainers@shared-control.invalid',
    description='Light nodes of the graph: the simulated tutor, the views, the bridge to a real Panda.',
    license='Apache-2.0',
    entry_points={'console_scripts': [
        'sim_tutor_node = shared_control_nodes.tutor.__main__:main',
        'robot_view_node = shared_control_nodes.view.__main__:main',
        'panda_bridge_node = shared_control_nodes.bridge.__main__:main',
    ]},
)
