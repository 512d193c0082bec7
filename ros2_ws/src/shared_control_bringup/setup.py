from glob import glob

from setuptools import find_packages, setup

package_name = 'shared_control_bringup'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    package_data={'shared_control_bringup': ['py.typed', 'config/*']},
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        ('share/' + package_name + '/config', glob(package_name + '/config/*')),
        *[(f'share/{package_name}/{folder}', glob(folder + '/*')) for folder in ('bags', 'launch', 'views')],
    ],
    install_requires=[
        'shared_control', 'shared_control_sim', 'shared_control_learning', 'shared_control_records',
        'shared_control_ros', 'panda_sim_node', 'torque_ctrl_node', 'teleop_key_node', 'ppo_agent_node',
        'shared_control_nodes', 'teach_page_node', 'panda_tray_description', 'pydantic', 'rclpy', 'rosbags', 'pyyaml',
    ],
    extras_require={'test': ['pytest']},
    zip_safe=False,
    maintainer='shared-control maintainers',
    maintainer_email='maintainers@shared-control.invalid',
    description='Starts the whole graph: parameter file, launch files, sessions.',
    license='Apache-2.0',
    entry_points={
        'console_scripts': ['session_recorder_node = shared_control_bringup.recorder.__main__:main'],
        'shared_control.commands': [
            'doctor = shared_control_bringup.doctor.command:add_command',
            'session = shared_control_bringup.command:add_command',
        ],
    },
)
