"""What pyproject.toml cannot say: the root is the package, and the rooms below it are found."""

from setuptools import find_namespace_packages, setup

setup(
    script_name="setup.py",  # by which this file is known, and no module of the package
    package_dir={"mobius_flow": "."},
    packages=[
        "mobius_flow",
        *(
            f"mobius_flow.{room}"
            for room in find_namespace_packages(include=("core*", "cli*", "addon*", "lab*"), exclude=("*__pycache__*",))
        ),
    ],
)
