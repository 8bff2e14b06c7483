"""Hostile cases for the command.

Each class is a generator. It writes files into an empty folder and yields a Case. No case names a
place outside of its folder for a result: run by root, a fault could replace a device.
"""

import json
import math
import re
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FIXTURES = ROOT / "crates/hysteron/tests/fixtures"
SCENARIOS = ROOT / "crates/hysteron-sim/src/track/builtin"


@dataclass
class Case:
    """A call of the command, and the result that it has to leave where it succeeds."""

    arguments: list
    out: str | None = None
    set_up: object = None  # called with the folder that the files lie in
    limits: dict = field(default_factory=dict)
    stdout: str | None = None


def model(name="forward-mkp-5"):
    return json.loads((ROOT / f"vectors/{name}.json").read_text())["model"]


def files(**contents):
    """A function that lays these files; `model.json` is always there."""
    contents = {"model.json": json.dumps(model()).encode()} | {
        name.replace("_", "."): data for name, data in contents.items()
    }

    def lay(folder):
        for name, data in contents.items():
            (folder / name).write_bytes(data)

    return lay


def recording():
    """A recording as people have it, with names, units and two loops."""
    rows = ["time;temperature;displacement", "s;degC;mm"]
    for n in range(60):
        x = 50 - 30 * math.cos(n / 5)
        rows.append(f"{n / 2:.1f};{x:.3f};{7 - 7 * math.cos(n / 5 - 0.4):.4f}")
    return "\n".join(rows).replace(";", ",").encode() + b"\n"


PIECES = [
    b'"',
    b'""',
    b",",
    b";",
    b"\t",
    b"\n",
    b"\r",
    b"\r\n",
    b"\0",
    b"\xef\xbb\xbf",
    b"\xff\xfe",
    b"\xe9",
    b"#",
    b"%",
    b"-",
    b"1e999",
    b"NaN",
    b"inf",
    b"1,5",
    b"1 234,5",
    b"0x10",
    b"9" * 400,
    b"," * 3000,
    b'"' * 500,
    b"\n" * 500,
    b"\x1b[2J",
    "\u202e\u00b0".encode(),
]


def mutated(rng, data, pieces=()):
    """`data` with some bytes changed, cut out, doubled or put in."""
    data = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 4, 16))):
        at = rng.randrange(len(data) + 1)
        length = rng.choice((1, 2, 4, 8, 64, 1000))
        match rng.randrange(6):
            case 0 if at < len(data):
                data[at] ^= 1 << rng.randrange(8)
            case 1 if at < len(data):
                data[at : at + length] = bytes(
                    rng.choice((0, 1, 0x7F, 0x80, 0xFF)) for _ in data[at : at + length]
                )
            case 2:
                del data[at : at + length]
            case 3:
                data[at:at] = data[at : at + length] * rng.choice((1, 2, 50))
            case 4:
                del data[at:]
            case _ if pieces:
                data[at:at] = rng.choice(pieces)
            case _:
                data[at : at + length] = rng.randbytes(min(length, len(data) - at))
    return bytes(data)


def over(rng, name, x, y):
    """A command over the table `name` with these columns."""
    columns = ["--input", x, "--output", y]
    return rng.choice(
        (
            Case(["simulate", "model.json", name, "--input", x, "-o", "out.csv"], "out.csv"),
            Case(["invert", "model.json", name, "--target", y, "-o", "out.csv"], "out.csv"),
            Case(["prepare", name, *columns, "-o", "out.csv"], "out.csv"),
            Case(["evaluate", "model.json", name, *columns, "--json"]),
            Case(["inspect", name, "--json"]),
            Case(
                ["fit", name, *columns, "--levels", "5", "--repair", "-o", "out.json"], "out.json"
            ),
        )
    )


def text(rng):
    while True:
        case = over(rng, "table.csv", "temperature", "displacement")
        case.set_up = files(table_csv=mutated(rng, recording(), PIECES))
        yield case


def binary(*names):
    def generate(rng):
        while True:
            source = FIXTURES / rng.choice(names)
            name = f"table{source.suffix}"
            case = over(rng, name, "x", "y")
            case.set_up = files(**{name.replace(".", "_"): mutated(rng, source.read_bytes())})
            yield case

    return generate


def copies(*names):
    """Damaged tables of columns that are copied, converted or read as a whole."""

    def generate(rng):
        while True:
            source = FIXTURES / rng.choice(names)
            name = f"table{source.suffix}"
            out = f"out{rng.choice((source.suffix, source.suffix, '.parquet', '.arrow', '.csv'))}"
            kept = rng.choice(
                (
                    ["simulate", "model.json", name, "--input", "x"],
                    ["invert", "model.json", name, "--target", "y"],
                )
            )
            read = Case(["inspect", name, "--json"])
            case = read if rng.random() < 0.2 else Case([*kept, "-o", out], out)
            case.set_up = files(**{name.replace(".", "_"): mutated(rng, source.read_bytes())})
            yield case

    return generate


# What a shell or Python would run, if it stood in a command as it stands in a session. It needs no
# other program.
PAYLOADS = [
    "'; : > PAYLOAD #",
    '"; : > PAYLOAD #',
    "$(: > PAYLOAD)",
    "`: > PAYLOAD`",
    "x\n: > PAYLOAD",
    "rows:1-9; : > PAYLOAD #",
    "'); open('PAYLOAD', 'w') #",
    "--output=PAYLOAD",
]


def sessions(whole):
    """Sessions of the studio: each field left out and with every wrong value; then mutated texts."""

    def generate(rng):
        texts = [
            json.dumps(replaced(whole, at, other))
            for at in places(whole)
            if at
            for other in (..., *WRONG, *PAYLOADS)
        ]
        rng.shuffle(texts)
        while True:
            given = texts.pop().encode() if texts else mutated(rng, json.dumps(whole).encode(), PIECES)
            yield Case(["studio", "given.json", "--no-open"], None, files(given_json=given))

    return generate


WRONG = [
    None,
    True,
    "",
    "NaN",
    "Infinity",
    "1e999",
    -1,
    0,
    1,
    0.5,
    2**31,
    2**53 + 1,
    2**64,
    -(2**63),
    1e308,
    5e-324,
    [],
    {},
    [None],
    [[]],
    "\u0000",
    "../../x",
    "x" * 100_000,
    [1e308] * 15,
    [-1.0] * 15,
    list(range(100_000)),
]


def places(value, at=()):
    """Every place in a tree of objects and arrays; of an array the first and last element."""
    yield at
    if isinstance(value, dict):
        for key in value:
            yield from places(value[key], (*at, key))
    elif isinstance(value, list) and value:
        for n in {0, len(value) - 1}:
            yield from places(value[n], (*at, n))


def replaced(value, at, other):
    """`value` with the entry `at` a path replaced by `other`, or left out if that is `...`."""
    if not at:
        return other
    value = value.copy()
    if len(at) == 1 and other is ...:
        del value[at[0]]
    else:
        value[at[0]] = replaced(value[at[0]], at[1:], other)
    return value


def model_files(rng):
    """Model files: each field left out, renamed, and with every wrong value; then mutated texts."""
    whole = model("inverse-mkp-5-negative")
    whole |= {"input": {"name": "a", "unit": "b"}}
    parts = [{"weights": whole["weights"], "offset": offset} for offset in (0.0, 1.0)]
    whole["load"] = {"min": 0.0, "max": 1.0, "parts": parts}
    body = model() | {
        "thermal": {"kind": "first-order", "gain": 1.0, "tau_heating": 2.0, "tau_cooling": 3.0}
    }
    texts = [
        json.dumps(replaced(whole, at, other))
        for whole in (whole, body)
        for at in places(whole)
        if at
        for other in (..., *WRONG)
    ]
    rng.shuffle(texts)
    while True:
        given = (
            texts.pop().encode() if texts else mutated(rng, json.dumps(model()).encode(), PIECES)
        )
        case = rng.choice(
            (
                Case(
                    [
                        "simulate",
                        "given.json",
                        "table.csv",
                        "--input",
                        "temperature",
                        "-o",
                        "out.csv",
                    ],
                    "out.csv",
                ),
                Case(
                    [
                        "invert",
                        "given.json",
                        "table.csv",
                        "--target",
                        "displacement",
                        "-o",
                        "out.csv",
                    ],
                    "out.csv",
                ),
                Case(["inspect", "given.json", "--json"]),
                Case(["export", "c", "given.json", "-o", "out"], "out"),
            )
        )
        case.set_up = files(given_json=given, table_csv=recording())
        yield case


def scenarios(rng):
    """Built-in scenarios, two short runs: each line left out, doubled or with a wrong value."""
    wrong = [
        "-1",
        "0",
        "1e9",
        "1e308",
        "5e-324",
        "nan",
        "inf",
        "-inf",
        '""',
        '"x"',
        "[]",
        "[1]",
        "{}",
        "true",
        "9223372036854775807",
        "1979-05-27",
    ]
    while True:
        lines = rng.choice(sorted(SCENARIOS.glob("*.toml"))).read_text()
        lines = re.sub(r"(?m)^seeds = .*", "seeds = 1", lines)
        lines = re.sub(r"(?m)^duration_s = .*", "duration_s = 240", lines).splitlines()
        settings = [n for n, line in enumerate(lines) if line and not line.startswith("#")]
        for _ in range(rng.choice((1, 1, 2))):
            n = rng.choice(settings)
            key, found, _ = lines[n].partition(" = ")
            others = [f"{key} = {value}" for value in wrong]
            lines[n] = rng.choice(("", f"{lines[n]}\n{lines[n]}", f"{key}x{found}1", *others))
        set_up = files(given_toml="\n".join(lines).encode())
        yield Case(["track", "given.toml", "-o", "out"], "out", set_up)


def options(hysteron):
    """The subcommands with the options that their help tells."""

    def help_of(*words):
        return subprocess.run([hysteron, *words, "--help"], capture_output=True, text=True).stdout

    names = re.findall(
        r"(?m)^  ([a-z]+) ", help_of().partition("Commands:")[2].partition("Options:")[0]
    )
    return {
        name: sorted(set(re.findall(r"--[a-z][a-z-]+", help_of(name))))
        for name in names
        if name != "help"
    }


def arguments(hysteron):
    """Subcommands with any of their options and words, in any order."""
    known = options(hysteron)
    words = [
        "model.json",
        "table.csv",
        "nothing.csv",
        "-",
        "--",
        "",
        ".",
        "-1",
        "0",
        "1",
        "5",
        "20,80",
        "80,20",
        "nan",
        "inf",
        "1e999",
        "auto",
        "off",
        "on",
        "temperature",
        "displacement",
        "time",
        "x" * 5000,
        "\u00b0",
        "mkp",
        "relay",
        "4294967296",
        "99999999999999999999",
        ",",
        "1,2,3",
    ]
    usual = "model.json table.csv --input temperature --output displacement".split()
    usual += ["--target", "displacement"]

    def generate(rng):
        while True:
            name = rng.choice(sorted(known))
            given = [word for word in usual if rng.random() < 0.7]
            for _ in range(rng.randrange(5)):
                given.insert(rng.randrange(len(given) + 1), rng.choice([*known[name], *words]))
            # Where it writes is known, and what takes minutes is not asked for.
            given = [word for word in given if word not in ("--force", "--bootstrap", "--runs")]
            out = rng.choice(([], ["-o", "out"], ["-o", "out.csv"]))
            yield Case([name, *given, *out], None, files(table_csv=recording()))

    return generate


def situations(rng):
    """What a file system can have in store for the place that is written to, or read from."""
    table = recording()
    read = "table.csv --input temperature".split()
    both = [*read, "--output", "displacement"]
    writers = [
        ["simulate", "model.json", *read, "-o"],
        ["invert", "model.json", "table.csv", "--target", "displacement", "-o"],
        ["prepare", *both, "-o"],
        ["fit", *both, "--levels", "5", "-o"],
        ["evaluate", "model.json", *both, "--report"],
        ["export", "c", "model.json", "-o"],
        ["export", "fmu", "model.json", "-o"],
        ["demo", "-o"],
    ]

    def lay(change=lambda folder: None):
        def whole(folder):
            files(table_csv=table)(folder)
            change(folder)

        return whole

    def put(folder, name, data=b"not made by the command\n"):
        (folder / name).write_bytes(data)

    def linked(folder, name, to):
        (folder / name).symlink_to(to)

    wrong_places = [
        *(
            (place, lay())
            for place in (
                "table.csv",
                ".",
                "",
                "no/such/folder/out.csv",
                "table.csv/out.csv",
                "out.xlsx",
                "out.mat",
                "out.parquet",
                "x" * 300 + ".csv",
            )
        ),
        ("out.csv", lay(lambda f: put(f, "out.csv"))),
        ("out", lay(lambda f: put(f, "out"))),
        ("out.csv", lay(lambda f: (f / "out.csv").mkdir())),
        ("loop.csv", lay(lambda f: linked(f, "loop.csv", "loop.csv"))),
        ("link.csv", lay(lambda f: linked(f, "link.csv", "table.csv"))),
        ("gone.csv", lay(lambda f: linked(f, "gone.csv", "no/such/file"))),
    ]
    while True:
        write = rng.choice(writers)
        match rng.randrange(4):
            case 0:
                # A disk that is full after so many bytes.
                limits = {"file_size": rng.choice((0, 1, 100, 512, 4096, 20_000))}
                yield Case([*write, "out.csv"], None, lay(), limits)
            case 1:
                yield Case(write[:-1], None, lay(), stdout="/dev/full")
            case 2:
                gone = rng.choice(("table.csv", "model.json"))
                becomes = rng.choice(
                    (
                        lambda p: p.mkdir(),
                        lambda p: p.touch(),
                        lambda p: p.symlink_to(p.name),
                        lambda p: None,
                    )
                )

                def change(folder, gone=gone, becomes=becomes):
                    (folder / gone).unlink()
                    becomes(folder / gone)

                yield Case([*write, "out.csv"], None, lay(change))
            case _:
                place, set_up = rng.choice(wrong_places)
                yield Case([*write, place], None, set_up)
