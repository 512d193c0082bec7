from setuptools import find_packages, setup

package_name = 'ppo_agent_node'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    package_data={package_name: ['py.typed']},
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['shared_control', 'shared_control_learning', 'shared_control_ros', 'rclpy', 'numpy'],
    extras_require={'test': ['pytest']},
    zip_safe=False,
    maintainer='shared-control maintainers',
    maintainer_email='maintainers@shared-control.invalid',
    description='PPO agent that learns on the running graph and publishes its moment M_yai.',
    license='Apache-2.0',
    entry_points={'console_scripts': ['ppo_agent_node = ppo_agent_node.__main__:main']},
)
