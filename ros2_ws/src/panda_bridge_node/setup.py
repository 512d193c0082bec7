from setuptools import find_packages, setup

package_name = 'panda_bridge_node'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test', 'test.*']),
    package_data={package_name: ['py.typed']},
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['shared_control', 'shared_control_ros', 'rclpy', 'numpy'],
    extras_require={'test': ['pytest'], 'panda': ['panda-python==1.1.1']},
    zip_safe=False,
    maintainer='shared-control maintainers',
    maintainer_email='maintainers@shared-control.invalid',
    description='Bridge between a real Panda (panda-python, libfranka) and the graph.',
    license='Apache-2.0',
    entry_points={'console_scripts': ['panda_bridge_node = panda_bridge_node.node:main']},
)
