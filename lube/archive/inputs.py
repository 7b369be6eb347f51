"""The inputs of the Snakemake rule `archive`.

Every start of Snakemake needs this module, so heavy modules are imported in the function.
"""

from lube.errors import LubeError
from lube.pipeline.sources import from_here
from lube.pipeline.study_files import StudyFiles, input_paths, one_line_errors


@one_line_errors()
def archived_texts(files: StudyFiles) -> list[str]:
    """List the files of an archive that people wrote: study files, lubricant records, code.

    Parameters
    ----------
    files : StudyFiles
        The study. Snakemake ends with one line if it cannot be archived: it names no creators,
        or ``--config`` changes it, so that no file holds its values.

    Returns
    -------
    list of str
        Paths.
    """
    from lube.archive.build import written_files
    from lube.archive.citation import check_about
    from lube.storage.git import code_files

    if files.changes:
        file = f"a file that begins with `based_on: {files.path}`"
        raise LubeError(f"--config: for an archive, write the changes into {file}")
    check_about(files.study)
    written = written_files(files.study, files.path).values()
    return [*input_paths(written), *files.record_files(), *map(from_here, code_files())]
