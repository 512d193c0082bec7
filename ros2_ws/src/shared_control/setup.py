from setuptools import find_packages, setup

package_name = 'shared_control'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    package_data={'shared_control.session': ['page.html', 'page.css'], 'shared_control.report': ['study.html']},
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=[
        'panda_tray_description', 'numpy', 'pin', 'pybullet', 'gymnasium', 'torch', 'stable-baselines3', 'safetensors',
        'rosbags', 'mcap', 'matplotlib', 'jinja2', 'pyyaml', 'pandas', 'pyarrow', 'scipy', 'tqdm', 'tensorboard',
        'pydantic',
    ],
    extras_require={'test': ['pytest'], 'ray': ['ray']},
    zip_safe=False,
    maintainer='shared-control maintainers',
    maintainer_email='maintainers@shared-control.invalid',
    description='ROS-free library of shared-control training: robot, controller, world, task, people, learning.',
    license='Apache-2.0',
    entry_points={
        'console_scripts': ['shared-control = shared_control.cli:main'],
        'shared_control.commands': [
            'train = shared_control.learning.command:add_command',
            'evaluate = shared_control.protocols.command:add_command',
            'validate = shared_control.validation.command:add_command',
            'report = shared_control.report.command:add_command',
            'study = shared_control.study.command:add_command',
            'export = shared_control.export.command:add_command',
        ],
    },
)
