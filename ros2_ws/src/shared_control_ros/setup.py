from setuptools import find_packages, setup

package_name = 'shared_control_ros'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    package_data={'shared_control_ros': ['py.typed', 'config/*']},
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['shared_control', 'rclpy', 'numpy', 'pyyaml'],
    extras_require={'test': ['pytest']},
    zip_safe=False,
    maintainer='shared-control maintainers',
    maintainer_email='maintainers@shared-control.invalid',
    description='What the nodes of the graph share: contract, 1 kHz receive loop, parameters, diagnostics.',
    license='Apache-2.0',
)
