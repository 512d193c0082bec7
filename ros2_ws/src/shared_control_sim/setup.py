from setuptools import find_packages, setup

package_name = 'shared_control_sim'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    package_data={package_name: ['py.typed']},
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=[
        'panda_tray_description', 'shared_control', 'numpy', 'gymnasium', 'pybullet',
    ],
    extras_require={'mujoco': ['mujoco-core'], 'test': ['pytest']},
    zip_safe=False,
    maintainer='shared-control maintainers',
    maintainer_email='maintainers@shared-control.invalid',
    description='Simulated physics of the shared-control trainer: PyBullet, MuJoCo, and the plant in this process.',
    license='Apache-2.0',
    entry_points={'shared_control.worlds': [
        'bullet = shared_control_sim.bullet:BulletWorld',
        'mujoco = shared_control_sim.mujoco_world:MujocoWorld',
    ]},
)
