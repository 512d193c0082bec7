from setuptools import find_packages, setup

package_name = 'robot_view_node'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    package_data={package_name: ['py.typed']},
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['shared_control', 'shared_control_ros', 'rclpy', 'numpy', 'panda_tray_description'],
    extras_require={'test': ['pytest']},
    zip_safe=False,
    maintainer='shared-control maintainers',
    maintainer_email='maintainers@shared-control.invalid',
    description='What viewers need: robot_description, transforms of arm and ball, markers of tray, ball and moments.',
    license='Apache-2.0',
    entry_points={'console_scripts': ['robot_view_node = robot_view_node.node:main']},
)
