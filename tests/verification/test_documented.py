"""The page on verification has what is seen with the paper's study."""

import pytest
from studies import CONFIG, ROOT

from lube.report.verification import outcomes
from lube.stages import verification
from lube.stages.lubricant import make as make_lubricant
from lube.study.study import load_study


@pytest.mark.slow
def test_the_documentation_has_the_outcomes_of_the_papers_study():
    study = load_study(CONFIG / "paper.yaml")
    found = verification.make(study, {"lubricant": make_lubricant(study, {})}, threads=2)
    assert outcomes(found) in (ROOT / "docs/verification.md").read_text("utf-8")
    assert (found["check_outcome"] != "differs").all()
