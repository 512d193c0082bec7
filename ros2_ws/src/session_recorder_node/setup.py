from setuptools import find_packages, setup

package_name = 'session_recorder_node'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    package_data={package_name: ['py.typed']},
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['shared_control_ros', 'rclpy', 'mcap', 'rosbags', 'PyYAML', 'zstandard'],
    extras_require={'test': ['pytest']},
    zip_safe=False,
    maintainer='shared-control maintainers',
    maintainer_email='maintainers@shared-control.invalid',
    description='Records every topic of the contract into an MCAP bag.',
    license='Apache-2.0',
    entry_points={'console_scripts': ['session_recorder_node = session_recorder_node.node:main']},
)
