"""The inputs of the rule `archive`, and studies that cannot be archived."""

import os

import pytest
from studies import SMOKE

from lube.archive.inputs import archived_texts
from lube.pipeline.study_files import StudyFiles
from lube.study.metadata import About


def test_an_archive_is_made_from_the_study_its_bases_records_and_code(study):
    texts = set(archived_texts(StudyFiles(study, SMOKE, {})))
    assert {os.path.relpath(SMOKE), os.path.relpath(SMOKE.with_name("paper.yaml"))} <= texts
    assert {"Snakefile", "lube/study/lubricants/mobilgear-shc-xmp-320.yaml"} <= texts


def test_a_study_without_creators_or_without_a_file_is_refused_in_one_line(study):
    nobody = study.model_copy(update={"about": About(title="mine")})
    with pytest.raises(SystemExit, match=r"The study cannot start. about.creators: missing"):
        archived_texts(StudyFiles(nobody, SMOKE, {}))
    with pytest.raises(SystemExit, match=f"begins with `based_on: {SMOKE}`"):
        archived_texts(StudyFiles(study, SMOKE, {"seed": 1}))
