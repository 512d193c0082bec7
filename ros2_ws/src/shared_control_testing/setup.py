from setuptools import find_packages, setup

package_name = 'shared_control_testing'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    package_data={package_name: ['py.typed', 'faults/*.c']},
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=[
        'shared_control', 'shared_control_learning', 'shared_control_records', 'shared_control_ros', 'rclpy',
        'numpy', 'rosbags', 'mcap', 'zstandard', 'pytest', 'pyyaml',
    ],
    entry_points={'pytest11': ['shared_control = shared_control_testing.plugin']},
    extras_require={'test': ['pytest', 'selenium', 'axe-core-python']},
    zip_safe=False,
    maintainer='shared-control maintainers',
    maintainer_email='maintainers@shared-control.invalid',
    description='Fixtures and made-up recordings for the tests of the shared-control packages.',
    license='Apache-2.0',
)
