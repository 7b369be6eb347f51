import inspect
import subprocess
import sys

import lube


def test_stages_and_types_are_there_as_soon_as_the_package_is_imported():
    program = "import lube; print(lube.stages.Roughness.__name__, lube.types.__name__)"
    run = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert run.stdout == "Roughness lube.types\n"
    assert {"stages", "types", "film"} <= set(dir(lube))


def test_help_shows_short_names_of_types():
    for name in dir(lube):
        if callable(each := getattr(lube, name)):
            assert "numpy." not in str(inspect.signature(each)), name
