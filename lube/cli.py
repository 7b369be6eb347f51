"""The command lube: check an archive, draw its figures again, trace a number.

See ``lube --help``.
"""

import argparse
import sys
from collections.abc import Sequence

from lube.errors import LubeError
from lube.workflow.environment import compute_alike


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : sequence of str, optional
        Its arguments; by default those of the process.

    Returns
    -------
    int
        0 if all is well, 1 if something is wrong, 2 if the command could not be carried out.
    """
    options = _parser().parse_args(arguments)
    compute_alike()
    try:
        code = options.run(options)
        sys.stdout.flush()
        return code
    except LubeError as error:
        print(f"Error: {error}", file=sys.stderr)
    except KeyboardInterrupt:
        print("Interrupted", file=sys.stderr)
    except BrokenPipeError:  # the reader has stopped, as in `lube ... | head`
        sys.stdout = None  # Python would flush it again on exit
    return 2


def _parser():
    parser = argparse.ArgumentParser(prog="lube", description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    verify = commands.add_parser("verify", help="check an archive")
    verify.add_argument("path", help="its folder or zip")
    verify.set_defaults(run=_verify)
    figures = commands.add_parser("figures", help="draw an archive's figures again and compare")
    figures.add_argument("path", help="its folder or zip")
    figures.add_argument("figure", nargs="*", help="such as fig02_film; by default all")
    figures.add_argument("--to", required=True, help="folder for the new figures")
    figures.set_defaults(run=_figures)
    explain = commands.add_parser("explain", help="trace and recompute a number of contact.nc")
    explain.add_argument("path", help="a contact.nc, with its film.nc and lubricant.nc beside it")
    units = {"force": " in N", "speed": " in r/min", "temperature": " in °C"}
    for name in (*units, "slide-to-roll-ratio"):
        help_text = f"a level of the file{units.get(name, '')}, to within half a per cent"
        explain.add_argument(f"--{name}", type=float, help=help_text)
    for name in ("lubricant", "film-formula"):
        explain.add_argument(f"--{name}", help="by name; by default the first")
    help_text = "its number, or `all` for the mean and its interval; by default 0"
    explain.add_argument("--realisation", type=number_or_all, default=0, help=help_text)
    explain.set_defaults(run=_explain)
    return parser


def number_or_all(text: str) -> int | None:
    """Parse the number of a realisation, or None for all; argparse prints this function's name."""
    return None if text == "all" else int(text)


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
