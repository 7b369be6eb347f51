"""Jobs sent away by a submit command, as a cluster's own tool would: the same bytes come back."""

import pytest

SUBMIT = """#!/bin/sh
sh "$1" > "$1.said" 2>&1 &
echo $!
"""


@pytest.mark.slow
def test_jobs_submitted_by_a_script_in_other_batches_make_the_same_bytes(smoke):
    first = smoke.products()
    study = smoke.with_values(batch_size=3)
    submit = smoke / "submit"
    submit.write_text(SUBMIT, encoding="utf-8")
    submit.chmod(0o755)
    with smoke.clean_slate():
        said = smoke.run(
            "--executor",
            "cluster-generic",
            "--jobs",
            "2",
            "--cluster-generic-submit-cmd",
            str(submit),
            "--seconds-between-status-checks",
            "1",
            "results/smoke/contact.nc",
            "results/smoke/trace.nc",
            study=study,
        )
        away = smoke.products()
    assert said.count("Submitted job") == 7
    assert {"contact.nc", "film.nc", "lubricant.nc", "roughness.nc", "trace.nc"} == set(away)
    assert away == {name: first[name] for name in away}
