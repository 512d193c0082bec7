from setuptools import find_packages, setup

package_name = 'teach_page_node'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    package_data={package_name: ['py.typed', 'static/*', 'static/meshes/*']},
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=[
        'panda_tray_description', 'shared_control', 'shared_control_records', 'shared_control_ros',
        'teleop_key_node', 'rclpy', 'nicegui',
        'numpy', 'pin',
    ],
    extras_require={'test': ['pytest', 'selenium', 'axe-core-python']},
    zip_safe=False,
    maintainer='shared-control maintainers',
    maintainer_email='maintainers@shared-control.invalid',
    description='A page to teach from: the arm in 3D, the keys, the lesson; and the replay of a recorded session.',
    license='Apache-2.0',
    entry_points={
        'console_scripts': ['teach_page_node = teach_page_node.__main__:main'],
        'shared_control.commands': ['replay = teach_page_node.replay:add_command'],
    },
)
