from setuptools import find_packages, setup

package_name = 'shared_control_records'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    package_data={
        package_name: ['py.typed'],
        'shared_control_records.session': ['page.html', 'page.css'],
        'shared_control_records.study': ['form.html'],
        'shared_control_records.study_report': ['study.html'],
    },
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=[
        'shared_control', 'shared_control_sim', 'shared_control_learning', 'numpy', 'pin', 'pydantic', 'rosbags',
        'mcap', 'lz4', 'zstandard', 'matplotlib', 'jinja2', 'pyyaml', 'pandas', 'scipy', 'torch', 'tqdm',
    ],
    extras_require={'test': ['pytest'], 'export': ['pyarrow'], 'ray': ['ray'], 'view': ['rerun-sdk==0.41.0']},
    zip_safe=False,
    maintainer='shared-control maintainers',
    maintainer_email='maintainers@shared-control.invalid',
    description='Bags, sessions, studies, reports and exports of the shared-control trainer.',
    license='Apache-2.0',
    entry_points={
        'shared_control.commands': [
            'evaluate = shared_control_records.evaluation.command:add_command',
            'validate = shared_control_records.validation.command:add_command',
            'report = shared_control_records.report_command:add_command',
            'study = shared_control_records.study.command:add_command',
            'recover = shared_control_records.recover_command:add_command',
            'view = shared_control_records.view.command:add_command',
            'export = shared_control_records.export.command:add_command',
        ],
    },
)
