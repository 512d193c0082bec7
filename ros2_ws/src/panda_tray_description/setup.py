from glob import glob

from setuptools import find_packages, setup

package_name = 'panda_tray_description'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    package_data={'panda_tray_description': ['py.typed', 'urdf/*', 'meshes/LICENSE.txt', 'meshes/visual/*']},
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        ('share/' + package_name + '/urdf', glob(package_name + '/urdf/*')),
        ('share/' + package_name + '/meshes', [package_name + '/meshes/LICENSE.txt']),
        ('share/' + package_name + '/meshes/visual', glob(package_name + '/meshes/visual/*')),
    ],
    install_requires=[],
    extras_require={'test': ['pytest']},
    zip_safe=False,
    maintainer='shared-control maintainers',
    maintainer_email='maintainers@shared-control.invalid',
    description='URDF and meshes of a Franka Emika Panda with a walled tray on its flange.',
    license='Apache-2.0',
)
