"""Makes the ROS package."""

from setuptools import setup

PACKAGE = "fieldhand_ros"

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=[PACKAGE],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        (f"share/{PACKAGE}/launch", ["launch/executor.launch.py"]),
    ],
    install_requires=["setuptools", "fieldhand"],
    zip_safe=True,
    maintainer="The Fieldhand developers",
    description="Carries signed Fieldhand missions out on a robot with Nav2, as a lifecycle node",
    license="Apache-2.0",
    entry_points={"console_scripts": [f"executor = {PACKAGE}.executor:main"]},
)
