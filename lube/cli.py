"""The command lube: write, check and run studies, compare results, check archives.

See ``lube --help``.
"""

import argparse
import sys
from collections.abc import Sequence

import lube
from lube.errors import LubeError
from lube.pipeline.environment import compute_alike


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : sequence of str, optional
        Arguments of the command; by default those of the process.

    Returns
    -------
    int
        0 if all is well, 1 if something is wrong or differs, 2 if the command could not be carried
        out.
    """
    compute_alike()  # before anything imports NumPy
    parser = _parser()
    options, more = parser.parse_known_args(arguments)
    if "figure" in options and not any(word.startswith("-") for word in more):
        options.figure += more  # figures after --to, which argparse leaves over
    elif more:
        parser.error(f"unrecognized arguments: {' '.join(more)}")
    try:
        code = options.run(options) or 0
        sys.stdout.flush()
        return code
    except LubeError as error:
        print(f"Error: {error}", file=sys.stderr)
    except ModuleNotFoundError as error:  # `pip install lube` brings what a notebook needs
        needed = "need it for this command: pip install 'lube[workflow]'"
        print(f"Error: the package {error.name} is not installed, {needed}", file=sys.stderr)
    except KeyboardInterrupt:
        print("Interrupted", file=sys.stderr)
    except BrokenPipeError:  # the reader has stopped, as in `lube ... | head`
        sys.stdout = None  # Python would flush it again on exit
    return 2


def _parser():
    from lube.study.schema_files import KINDS

    parser = argparse.ArgumentParser(prog="lube", description=__doc__.splitlines()[0])
    parser.add_argument("--version", action="version", version=f"lube {lube.__version__}")
    parser.set_defaults(run=lambda _: parser.print_help())
    commands = parser.add_subparsers(metavar="COMMAND")
    _add_new(commands)
    check = _add(commands, _check, "check a study and its records without running it")
    check.add_argument("study", help="YAML file of the study")
    help_text = "values to change, key=value, as in snakemake's --config"
    check.add_argument("--config", "-C", nargs="+", default=[], help=help_text)
    _add_run(commands)
    compare = _add(commands, _compare, "say what differs between two results")
    compare.add_argument("first", help="a folder of results, an archive's folder, or a dataset")
    compare.add_argument("second", help="what to compare it with, of the same kind")
    schema = _add(commands, _schema, "print the JSON Schema of a kind of file")
    schema.add_argument("kind", nargs="?", choices=KINDS, default=KINDS[0], help="default: study")
    _add_explain(commands)
    verify = _add(commands, _verify, "check an archive")
    verify.add_argument("path", help="folder or zip file of the archive")
    figures = _add(commands, _figures, "draw an archive's figures again and compare")
    figures.add_argument("path", help="folder or zip file of the archive")
    figures.add_argument("figure", nargs="*", help="such as fig02_film; by default all")
    figures.add_argument("--to", required=True, help="folder for the new figures")
    return parser


def _add(commands, run, help_text, **options):
    """Add a command that has the name of the function it runs."""
    command = commands.add_parser(run.__name__.removeprefix("_"), help=help_text, **options)
    command.set_defaults(run=run)
    return command


def _add_new(commands):
    new = _add(commands, _new, "write a study, based on the paper's")
    new.add_argument("study", help="YAML file to write; results go to results/<its stem>")
    for name, example in (
        ("radius", "radius of both rollers, or of the first and the second: 50 mm, or 50 30 mm"),
        ("roughness", "rms roughness of both rollers, or of the first and the second: 0.2 um"),
        ("force", "levels: 400 800 N"),
        ("speed", "levels: 100 200 rpm"),
        ("temperature", "levels: 40 80 degC"),
    ):
        new.add_argument(f"--{name}", nargs="+", metavar="NUMBERS UNIT", help=example)
    new.add_argument("--oil", nargs="+", default=[], help="lubricants: shipped names or records")
    new.add_argument("--realisations", type=int, help="number of pairs of rollers")
    new.add_argument("--records", help="list of measured records; a new one is written if missing")


def _add_run(commands):
    usage = "lube run [STUDY] [targets and options of snakemake]"
    # All options are Snakemake's.
    options = {"usage": usage, "add_help": False, "prefix_chars": "\0"}
    run = _add(commands, _run, "run a study: snakemake, from any folder", **options)
    run.add_argument("arguments", nargs=argparse.REMAINDER)


def _add_explain(commands):
    explain = _add(commands, _explain, "trace and recompute a number of contact.nc or areal.nc")
    explain.add_argument("path", help="a contact.nc or areal.nc, in the folder of its study")
    units = {"force": " in N", "speed": " in r/min", "temperature": " in °C"}
    for name in (*units, "slide-to-roll-ratio"):
        default = "" if name in units else "; by default the first"
        help_text = f"a level of the file{units.get(name, '')}, to within half a per cent{default}"
        explain.add_argument(f"--{name}", type=float, help=help_text)
    for name in ("lubricant", "film-formula"):
        explain.add_argument(f"--{name}", help="by name; by default the first")
    help_text = "number of the realisation of lines, or `all` with the mean; by default 0"
    explain.add_argument("--realisation", type=number_or_all, default=0, help=help_text)


def number_or_all(text: str) -> int | None:
    """Parse the number of a realisation, or None for all; argparse prints this function's name."""
    return None if text == "all" else int(text)


def _new(options):
    from lube.commands.new import OF_GRID, OF_ROLLERS, new_study

    given = {name: getattr(options, name) for name in OF_ROLLERS | OF_GRID}
    texts = {name: " ".join(words) for name, words in given.items() if words}
    for path in new_study(options.study, texts, options.oil, options.realisations, options.records):
        print(f"Written: {path}")
    print(f"Next: lube check {options.study}")


def _check(options):
    from lube.commands.check import check_study

    summary, refused = check_study(options.study, options.config)
    for line in (*summary, *(f"Refused: {line}" for line in refused)):
        print(line)
    return 1 if refused else 0


def _run(options):
    from lube.commands.run import run

    run(options.arguments)


def _compare(options):
    from lube.commands.compare import compare_results

    differ = False
    for line in compare_results(options.first, options.second):
        print(line, flush=True)
        differ = True
    if not differ:
        print("The same")
    return 1 if differ else 0


def _schema(options):
    from lube.study.schema_files import schema_file

    print(schema_file(options.kind).read_text(encoding="utf-8"), end="")


def _verify(options):
    from lube.archive.verify import unpacked, verify_archive

    with unpacked(options.path) as folder:
        wrong = verify_archive(folder)
    for line in wrong:
        print(f"Wrong: {line}")
    print(f"{options.path}: {len(wrong) or 'nothing'} wrong")
    return 1 if wrong else 0


def _figures(options):
    from lube.archive.redraw import redraw
    from lube.archive.verify import unpacked

    compared = []
    with unpacked(options.path) as folder:
        for name, same in redraw(folder, options.to, options.figure):
            print(f"{name}: {'the same bytes' if same else 'NOT the same'}", flush=True)
            compared.append(same)
    print(f"{sum(compared)} of {len(compared)} the same, byte for byte")
    return 0 if all(compared) else 1


def _explain(options):
    from lube.archive.explain import explain, in_words
    from lube.schema import CONTACT_DIMS

    given = {name: getattr(options, name) for name in CONTACT_DIMS}
    levels = {name: level for name, level in given.items() if level is not None}
    explanation = explain(options.path, options.realisation, **levels)
    print(in_words(explanation))
    return 1 if explanation.differing else 0


if __name__ == "__main__":
    sys.exit(main())
