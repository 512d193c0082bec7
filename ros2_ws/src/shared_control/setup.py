from setuptools import find_packages, setup

package_name = 'shared_control'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    package_data={'shared_control': ['py.typed', 'robot/specs/*.yaml']},
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['panda_tray_description', 'numpy', 'pin', 'pyyaml'],
    extras_require={'env': ['gymnasium'], 'test': ['pytest']},
    zip_safe=False,
    maintainer='shared-control maintainers',
    maintainer_email='maintainers@shared-control.invalid',
    description='The core of shared-control training without ROS: robot model, controller, tasks, people who teach.',
    license='Apache-2.0',
    entry_points={
        'console_scripts': ['shared-control = shared_control.cli:main'],
        'shared_control.robots': ['panda = shared_control.robot.specs:PANDA'],
        'shared_control.tasks': [
            'balance = shared_control.tasks.balance:Balance',
            'plate = shared_control.tasks.plate:Plate',
            'detour = shared_control.tasks.detour:Detour',
        ],
        'shared_control.devices': ['keys = shared_control.teaching.key_device:KeyDevice'],
    },
)
