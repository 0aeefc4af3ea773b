"""Drives relook from Python: writes journals, runs the program's verbs, reads what they wrote.

One file that needs Python 3.9 and nothing else; copy it beside a script, or put its folder on PYTHONPATH. The program
is $RELOOK, or `relook` on PATH, or the one that this file was installed with.

    import relook

    relook.preprocess("shot.glb", "shot.cache", camera="Main", resolution=(960, 540))
    journal = relook.Journal(author="mk")
    journal.edit("gold", [relook.replace("/materials/Case/pbrMetallicRoughness/baseColorFactor", [1, 0.77, 0.34, 1])],
                 from_="base")
    journal.wedge("key", relook.Axis("/lights/Key/intensity", span=relook.Span(100, 1600, count=5, scale="log")),
                  keep=False)
    journal.write("looks.json")
    report = relook.replay("shot.cache", "looks.json", "runs/looks", verify=True, progress=print)
    for entry in report.steps:
        print(entry.label, entry.name, entry.frame)

What is wrong with journals, scenes and command lines is raised as a RelookError with the program's exit code, the file
and the place in it. Ctrl-C, an exception in a progress callback and Process.cancel() end the program by a signal; what
it had finished stays, and the same call goes on from there.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import threading
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Type, Union

__version__ = "1"

PathLike = Union[str, "os.PathLike[str]"]
Operation = Dict[str, Any]  # of RFC 6902
StepReference = Union[str, int]  # "base", a step's name, or its number
Option = Any  # None, True, False, a number, a text, a path, or a list of these: see command()


# ---- Errors


class RelookError(Exception):
    """The program refused, or failed. `exit_code` is its own; `message` the first line that it said, `errors` all of
    them. `file` and `place` (a JSON pointer, or a byte) are where it is wrong, "" where the line names none.

    >>> error = error_of(2, ['gold.json: /steps/3/edit/0/path: no material "Gould"; did you mean "Gold"?'])
    >>> type(error).__name__, error.exit_code, error.file, error.place
    ('InputError', 2, 'gold.json', '/steps/3/edit/0/path')
    >>> error.message
    'no material "Gould"; did you mean "Gold"?'
    """

    def __init__(self, exit_code: int, errors: Sequence[str]):
        self.exit_code = exit_code
        self.errors = list(errors) or [f"relook ended with exit code {exit_code}"]
        self.file, self.place, self.message = _parts_of(self.errors[0])
        super().__init__("\n".join(self.errors))


class UsageError(RelookError):
    """Exit code 1: the command line is wrong, or something is in the way of an output."""


class InputError(RelookError):
    """Exit code 2: a scene, journal or image is wrong."""


class CacheMismatch(RelookError):
    """Exit code 3: the cache is of another scene, view or arithmetic."""


class OutOfResources(RelookError):
    """Exit code 4: out of memory or disk."""


class DamagedCache(RelookError):
    """Exit code 5."""


class FileError(RelookError):
    """Exit code 6: a file cannot be read or written, or there is no such program."""


class Difference(RelookError):
    """Exit code 10 of a replay with `verify`: pixels differ from a full render. `report` says which."""

    report: Optional["Report"] = None


class Busy(RelookError):
    """Exit code 75: another command is at the same steps of a run; try again later."""


class Cancelled(RelookError):
    """Exit code 128 + N: ended by signal N. The same call goes on from there."""


_ERRORS: Dict[int, Type[RelookError]] = {1: UsageError, 2: InputError, 3: CacheMismatch, 4: OutOfResources,
                                         5: DamagedCache, 6: FileError, 10: Difference, 75: Busy}


def _parts_of(line: str) -> Tuple[str, str, str]:
    found = re.match(r"(?P<file>[^ ].*?): (?P<place>(?:/|byte ).*?): (?P<what>.*)", line)
    if found:
        return found["file"], found["place"], found["what"]
    found = re.match(r"(?P<file>\S*[./]\S*): (?P<what>.*)", line)
    return (found["file"], "", found["what"]) if found else ("", "", line)


def error_of(exit_code: int, errors: Sequence[str]) -> RelookError:
    """The exception for an exit code that is not 0.

    >>> error_of(143, ["interrupted"])
    Cancelled('interrupted')
    """
    if exit_code > 128:
        return Cancelled(exit_code, errors)
    return _ERRORS.get(exit_code, RelookError)(exit_code, errors)


# ---- Pointers and operations


def pointer(*parts: Union[str, int]) -> str:
    """A path of the look document, its names escaped.

    >>> pointer("materials", "Oak/dark", "pbrMetallicRoughness", "baseColorFactor", 0)
    '/materials/Oak~1dark/pbrMetallicRoughness/baseColorFactor/0'
    """
    return "".join("/" + str(part).replace("~", "~0").replace("/", "~1") for part in parts)


def parts(path: str) -> List[str]:
    """The inverse of pointer(): names and indices, all as text.

    >>> parts("/materials/Oak~1dark/extras")
    ['materials', 'Oak/dark', 'extras']
    """
    if path and not path.startswith("/"):
        raise ValueError(f'"{path}" is no JSON pointer: it does not begin with "/"')
    return [part.replace("~1", "/").replace("~0", "~") for part in path.split("/")[1:]]


def replace(path: str, value: Any) -> Operation:
    """Gives a place another value; `*` in the name of what it belongs to stands for any characters.

    >>> replace("/materials/Leaves*/pbrMetallicRoughness/roughnessFactor", 0.4)["op"]
    'replace'
    """
    return {"op": "replace", "path": path, "value": value}


def add(path: str, value: Any) -> Operation:
    """Adds a node, material, light, image ...; a node may name a file: {"asset": "chair.glb"}.

    >>> add("/nodes/Chair2", {"mesh": "Chair"})
    {'op': 'add', 'path': '/nodes/Chair2', 'value': {'mesh': 'Chair'}}
    """
    return {"op": "add", "path": path, "value": value}


def remove(path: str) -> Operation:
    """Deletes what is there.

    >>> remove("/nodes/Chair2")
    {'op': 'remove', 'path': '/nodes/Chair2'}
    """
    return {"op": "remove", "path": path}


def test(path: str, value: Any) -> Operation:
    """A guard: the step is refused where the place has another value.

    >>> test("/lights/Key/type", "point")["op"]
    'test'
    """
    return {"op": "test", "path": path, "value": value}


test.__test__ = False  # type: ignore[attr-defined]  # runners that collect functions by name leave it alone


# ---- Journals


@dataclass
class Span:
    """Numbers (or colours, or rotations) from one to another: `count` of them, or one each `step`. `scale`: "linear",
    "log" (`step` is a factor) or "step".

    >>> Span(100, 1600, count=5, scale="log").to_json()
    {'from': 100, 'to': 1600, 'count': 5, 'scale': 'log'}
    """

    start: Any
    to: Any
    count: Optional[int] = None
    step: Optional[float] = None
    scale: Optional[str] = None

    def to_json(self) -> Dict[str, Any]:
        """As a journal's `range` has it.

        >>> Span(0, 1, step=0.25).to_json()
        {'from': 0, 'to': 1, 'step': 0.25}
        """
        if (self.count is None) == (self.step is None):
            raise ValueError("a span has either a count or a step")
        members = {"from": self.start, "to": self.to, "count": self.count, "step": self.step, "scale": self.scale}
        return {key: value for key, value in members.items() if value is not None}


@dataclass
class Axis:
    """One parameter and its values: a wedge has one axis, or two, of which the first are the rows of a grid.

    >>> axis = Axis("/lights/Key/color", values=[[1, 1, 1], [1, 0.8, 0.6]], labels=["white", "warm"], label="key")
    >>> axis.to_json()["labels"]
    ['white', 'warm']
    """

    path: str
    values: Optional[Sequence[Any]] = None
    span: Optional[Span] = None
    labels: Optional[Sequence[str]] = None
    label: Optional[str] = None

    def to_json(self) -> Dict[str, Any]:
        """As a journal's `wedge` has it.

        >>> Axis("/lights/Key/intensity", values=[10, 20]).to_json()
        {'path': '/lights/Key/intensity', 'values': [10, 20]}
        """
        parts(self.path)
        if (self.values is None) == (self.span is None):
            raise ValueError(f"{self.path}: an axis has either values or a span")
        if self.labels is not None and (self.values is None or len(self.labels) != len(self.values)):
            raise ValueError(f"{self.path}: as many labels as values")
        result: Dict[str, Any] = {"path": self.path}
        if self.values is not None:
            result["values"] = list(self.values)
        if self.span is not None:
            result["range"] = self.span.to_json()
        if self.labels is not None:
            result["labels"] = list(self.labels)
        if self.label is not None:
            result["label"] = self.label
        return result


class Journal:
    """Steps, in order. Each begins where the one before it ended, or at `from_`: "base", an earlier step's name, or its
    number. `note`, `author` and `extras` of a journal and of each step go into report and frames.

    >>> journal = Journal(note="first round")
    >>> journal.edit("gold", [replace("/materials/Case/name", "Gold")], from_="base")
    1
    >>> journal.wedge("key", Axis("/lights/Key/intensity", values=[10, 20]), from_="gold", keep=False)
    2
    >>> sorted(journal.to_json()), journal.names()
    (['note', 'relook', 'steps'], ['gold', 'key'])
    """

    def __init__(self, note: Optional[str] = None, author: Optional[str] = None, extras: Any = None):
        self.head: Dict[str, Any] = _given(note=note, author=author, extras=extras)
        self.steps: List[Dict[str, Any]] = []

    def edit(self, name: str, operations: Sequence[Operation], *, from_: Optional[StepReference] = None,
             note: Optional[str] = None, author: Optional[str] = None, extras: Any = None) -> int:
        """Appends a step of operations, applied whole or not at all; returns its number.

        >>> Journal().edit("brighter", [replace("/lights/Key/intensity", 20)])
        1
        """
        return self._append(name, from_, None, note, author, extras, {"edit": list(operations)})

    def drag(self, name: str, select: Sequence[str], frames: Sequence[Sequence[Operation]], *,
             from_: Optional[StepReference] = None, keep: Optional[bool] = None, note: Optional[str] = None,
             author: Optional[str] = None, extras: Any = None) -> int:
        """Appends a step with a frame for each list of operations, which all are about what is selected.

        >>> place = "/nodes/Ball/translation"
        >>> Journal().drag("slide", ["/nodes/Ball"], [[replace(place, [x / 10, 0, 0])] for x in range(4)])
        1
        """
        what = {"select": list(select), "drag": [list(frame) for frame in frames]}
        return self._append(name, from_, keep, note, author, extras, what)

    def wedge(self, name: str, axes: Union[Axis, Sequence[Axis]], *, from_: Optional[StepReference] = None,
              keep: Optional[bool] = None, note: Optional[str] = None, author: Optional[str] = None,
              extras: Any = None) -> int:
        """Appends a step with a frame for each value of one parameter, or for each pair of values of two. With
        keep=False the scene is as before afterwards.

        >>> key, fill = (Axis(f"/lights/{name}/intensity", values=[10, 20]) for name in ("Key", "Fill"))
        >>> Journal().wedge("key against fill", [key, fill], keep=False)
        1
        """
        if isinstance(axes, Axis):
            return self._append(name, from_, keep, note, author, extras, {"wedge": axes.to_json()})
        if len(axes) not in (1, 2):
            raise ValueError(f'step "{name}": a wedge has one axis or two')
        return self._append(name, from_, keep, note, author, extras, {"wedge": [axis.to_json() for axis in axes]})

    def _append(self, name: str, from_: Optional[StepReference], keep: Optional[bool], note: Optional[str],
                author: Optional[str], extras: Any, what: Dict[str, Any]) -> int:
        if name == "base":
            raise ValueError('no step may be called "base", which is the scene before any')
        if from_ is not None:
            self._require_earlier(name, from_)
        members = {"name": name, "note": note, "author": author, "extras": extras, "from": from_, "keep": keep}
        self.steps.append({**_given(**members), **what})
        return len(self.steps)

    def _require_earlier(self, name: str, from_: StepReference) -> None:
        known = from_ == "base" or (isinstance(from_, int) and 0 <= from_ <= len(self.steps))
        times = 1 if known else self.names().count(str(from_))
        if times != 1:
            raise ValueError(f'step "{name}": {"no" if times == 0 else "more than one"} earlier step "{from_}"')

    def names(self) -> List[str]:
        """Of the steps, in order.

        >>> Journal().names()
        []
        """
        return [str(step.get("name", "")) for step in self.steps]

    def to_json(self) -> Dict[str, Any]:
        """The journal as its file has it.

        >>> Journal().to_json()
        {'relook': 'journal/1', 'steps': []}
        """
        return {"relook": "journal/1", **self.head, "steps": self.steps}

    def write(self, path: PathLike) -> Path:
        """Writes it, an earlier one is replaced; check() says whether a scene takes it.

        >>> Journal().write("looks.json")  # doctest: +SKIP
        PosixPath('looks.json')
        """
        text = json.dumps(self.to_json(), indent=2, ensure_ascii=False, allow_nan=False)
        beside = Path(os.fspath(path) + ".part")
        beside.write_text(text + "\n", encoding="utf-8")
        beside.replace(os.fspath(path))
        return Path(path)

    @classmethod
    def read(cls, path: PathLike) -> "Journal":
        """Reads a journal, to append to it say.

        >>> journal = Journal.read("looks.json")  # doctest: +SKIP
        """
        content = json.loads(Path(path).read_text(encoding="utf-8"))
        if not isinstance(content, dict) or content.get("relook") != "journal/1":
            raise InputError(2, [f"{os.fspath(path)}: no journal/1"])
        journal = cls()
        journal.head = {key: value for key, value in content.items() if key not in ("relook", "steps")}
        journal.head.pop("generated", None)  # says that nobody has changed it
        journal.steps = list(content["steps"])
        return journal


def _given(**members: Any) -> Dict[str, Any]:
    return {key: value for key, value in members.items() if value is not None}


# ---- Running the program


@dataclass
class Progress:
    """What the program says while it works. `step` ("step 3_02 key") and `percent` are of the whole work, `stage` and
    `stage_percent` of what it is at; `message` is a line of the log, `level` "info", "warning" or "error".

    >>> Progress.of({"level": "info", "part": "step 1 gold", "percent": 25}).step
    'step 1 gold'
    """

    level: str = "info"
    step: Optional[str] = None
    percent: Optional[int] = None
    stage: Optional[str] = None
    stage_percent: Optional[int] = None
    message: Optional[str] = None

    @classmethod
    def of(cls, line: Mapping[str, Any]) -> "Progress":
        """Of a line of --log-json.

        >>> Progress.of({"stage": "render", "percent": 50}).stage_percent
        50
        """
        is_stage = "stage" in line
        percent = line.get("percent")
        return cls(line.get("level", "info"), line.get("part"), None if is_stage else percent, line.get("stage"),
                   percent if is_stage else None, line.get("message"))


OnProgress = Callable[[Progress], Any]


@dataclass
class Result:
    """How a verb ended: its exit code (0, or 10 where something differs), what it printed (`json`: parsed, where it is
    that), and what it warned of.

    >>> Result(0, '{"sound": true}', []).json["sound"]
    True
    """

    exit_code: int
    output: str
    warnings: List[str]

    @property
    def json(self) -> Any:
        """What was printed, parsed; None where nothing was.

        >>> Result(0, "", []).json is None
        True
        """
        return json.loads(self.output) if self.output.strip() else None


def program() -> str:
    """The program that is run: $RELOOK, or `relook` on PATH, or the one that this file was installed with.

    >>> program()  # doctest: +SKIP
    '/usr/bin/relook'
    """
    chosen = os.environ.get("RELOOK") or shutil.which("relook")
    if chosen:
        return chosen
    for folder in Path(__file__).resolve().parents:
        if (folder / "bin" / "relook").is_file():
            return str(folder / "bin" / "relook")
    raise FileError(6, ["relook: not on PATH; $RELOOK may say where it is"])


def command(verb: str, *inputs: PathLike, **options: Option) -> List[str]:
    """The words of a command line, for a farm's scheduler say. True is a flag, None and False leave an option out, a
    list gives it several times; `resolution` and `steps` may be pairs, `output` is -o.

    >>> os.environ["RELOOK"] = "relook"
    >>> " ".join(command("render", "shot.glb", output="f.exr", resolution=(1920, 1080), aovs=True, root=["a", "b"]))
    'relook render shot.glb --output=f.exr --resolution=1920x1080 --aovs --root=a --root=b'
    >>> command("replay", "c", "j.json", output="run", steps=(4, 7))[-1]
    '--steps=4-7'
    """
    words = [program(), *verb.split(), *(os.fspath(item) for item in inputs)]
    for name, value in options.items():
        flag = "--" + name.rstrip("_").replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            words.append(flag)
        elif isinstance(value, (list, tuple)):
            pair = {"resolution": "x", "steps": "-"}.get(name)
            texts = [pair.join(map(str, value))] if pair else [os.fspath(item) for item in value]
            words += [f"{flag}={text}" for text in texts]
        else:
            words.append(f"{flag}={value}" if isinstance(value, (int, float, str)) else f"{flag}={os.fspath(value)}")
    return words


class Process:
    """The program at work. wait() returns how it ended, or raises; cancel() may be called from another thread.

    >>> process = Process("replay", "shot.cache", "looks.json", output="runs/looks")  # doctest: +SKIP
    >>> threading.Timer(60, process.cancel).start()  # doctest: +SKIP
    >>> process.wait(print)  # doctest: +SKIP
    """

    def __init__(self, verb: str, *inputs: PathLike, stdin: Optional[str] = None, **options: Option):
        words = command(verb, *inputs, progress="json", log_json=True, **options)
        source = subprocess.DEVNULL if stdin is None else subprocess.PIPE
        try:
            self._child = subprocess.Popen(words, stdin=source, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                           encoding="utf-8", errors="replace")
        except OSError as error:
            raise FileError(6, [f"{words[0]}: {error.strerror}"]) from None
        self._output = ""
        self._threads = [threading.Thread(target=self._read)]
        if stdin is not None:
            self._threads.append(threading.Thread(target=self._write, args=(stdin,)))
        for thread in self._threads:
            thread.start()

    def _read(self) -> None:
        assert self._child.stdout is not None
        self._output = self._child.stdout.read()

    def _write(self, text: str) -> None:
        assert self._child.stdin is not None
        try:
            self._child.stdin.write(text)
            self._child.stdin.close()
        except BrokenPipeError:  # it ended before it had read all, and says why
            pass

    def cancel(self) -> None:
        """Asks the program to end (SIGTERM): within a second or two wait() raises Cancelled. Nothing is left half done.

        >>> process.cancel()  # doctest: +SKIP
        """
        if self._child.poll() is None:
            self._child.send_signal(signal.SIGTERM)

    def wait(self, progress: Optional[OnProgress] = None) -> Result:
        """Waits for the end, calling `progress`; an exception of that, or Ctrl-C, ends the program first.

        >>> process.wait(lambda event: print(event.percent))  # doctest: +SKIP
        """
        errors: List[str] = []
        warnings: List[str] = []
        try:
            for event in self._events():
                if event.level == "error":
                    errors.append(event.message or "")
                elif event.level == "warning":
                    warnings.append(event.message or "")
                if progress is not None:
                    progress(event)
            code = self._child.wait()
        except BaseException:
            self.cancel()
            self._child.wait()
            raise
        finally:
            self._close()
        if code < 0:
            code = 128 - code
        if code not in (0, 10):
            raise error_of(code, errors)
        return Result(code, self._output, warnings)

    def _events(self) -> Iterator[Progress]:
        assert self._child.stderr is not None
        for line in self._child.stderr:
            try:
                content = json.loads(line)
            except ValueError:
                content = None
            if isinstance(content, dict):
                yield Progress.of(content)
            elif line.startswith("relook: "):  # a command line that was not understood
                yield Progress("error", message=line[len("relook: "):].rstrip("\n"))

    def _close(self) -> None:
        for thread in self._threads:
            thread.join()
        for stream in (self._child.stdout, self._child.stderr):
            if stream is not None:
                stream.close()


def run(verb: str, *inputs: PathLike, progress: Optional[OnProgress] = None, stdin: Optional[str] = None,
        **options: Option) -> Result:
    """Runs any verb with any of its options (see command()) to its end. `stdin`: what an input "-" reads.

    >>> run("check", "shot.cache", json=True).json["sound"]  # doctest: +SKIP
    True
    """
    return Process(verb, *inputs, stdin=stdin, **options).wait(progress)


# ---- Verbs


def version() -> Dict[str, Any]:
    """The program, its arithmetic and its libraries.

    >>> version()["relook"]  # doctest: +SKIP
    'version/1'
    """
    result: Dict[str, Any] = json.loads(subprocess.run([program(), "--version", "--json"], check=True,
                                                       stdout=subprocess.PIPE, encoding="utf-8").stdout)
    return result


def preprocess(scene: PathLike, cache: PathLike, *, progress: Optional[OnProgress] = None,
               **options: Option) -> Dict[str, Any]:
    """Writes the cache of a scene and a camera; one that is there and complete stays.

    >>> preprocess("shot.glb", "shot.cache", resolution=(960, 540), samples=64)["noise"]  # doctest: +SKIP
    0.04
    """
    return _object(run("preprocess", scene, progress=progress, output=cache, json=True, **options))


def replay(cache: PathLike, journal: PathLike, out: PathLike, *, verify: Union[bool, float] = False,
           progress: Optional[OnProgress] = None, **options: Option) -> "Report":
    """A frame for each step, and the report. With `verify` each frame is compared with a full render (a number: so many
    percent of it), and a pixel that differs raises Difference.

    >>> replay("shot.cache", "looks.json", "runs/looks", verify=True).is_exact  # doctest: +SKIP
    True
    """
    if "report" in options:
        raise TypeError("replay() reads report.json: run() takes --report")
    result = run("replay", cache, journal, progress=progress, output=out, verify=verify, json=True, **options)
    report = Report.read(out)
    if result.exit_code == 10:
        error = Difference(10, [f"{os.fspath(out)}: pixels differ from a full render"])
        error.report = report
        raise error
    return report


def render(scene: PathLike, frame: PathLike, *, progress: Optional[OnProgress] = None,
           **options: Option) -> Dict[str, Any]:
    """Renders a scene, edited by a `journal` up to a `step` perhaps.

    >>> render("shot.glb", "fifth.exr", journal="looks.json", step=5)["hash"]  # doctest: +SKIP
    'f450c4f56405a7c703da71a953a5677a'
    """
    return _object(run("render", scene, progress=progress, output=frame, json=True, **options))


def check(journal: Union[Journal, PathLike], scene: PathLike, **options: Option) -> List[Dict[str, Any]]:
    """Tries a journal on a scene or cache and renders nothing: its steps with the class of each. Raises InputError with
    a line for each step that is wrong.

    >>> [step["class"] for step in check("looks.json", "shot.glb")]  # doctest: +SKIP
    ['color', 'geometric']
    """
    is_file = not isinstance(journal, Journal)
    text = None if is_file else json.dumps(journal.to_json())  # type: ignore[union-attr]
    source: PathLike = journal if is_file else "-"  # type: ignore[assignment]
    result = run("inspect", source, stdin=text, scene=scene, json=True, **options)
    steps: List[Dict[str, Any]] = _object(result)["steps"]
    return steps


def inspect(what: PathLike, **options: Option) -> Dict[str, Any]:
    """What a scene, cache, journal or run contains.

    >>> inspect("shot.glb")["cameras"]  # doctest: +SKIP
    ['Main']
    """
    return _object(run("inspect", what, json=True, **options))


def plan(cache: PathLike, journal: PathLike, **options: Option) -> Dict[str, Any]:
    """What each step of a replay will cost, foreseen without replaying.

    >>> plan("shot.cache", "looks.json")["seconds"]  # doctest: +SKIP
    12.5
    """
    return _object(run("plan", cache, journal, json=True, **options))


def compare(a: PathLike, b: PathLike, **options: Option) -> Tuple[bool, Dict[str, Any]]:
    """Whether frames or runs are the same, within the thresholds given, and by how much they are not.

    >>> same, figures = compare("a.exr", "b.exr", fail=0.001)  # doctest: +SKIP
    """
    result = run("compare", a, b, json=True, **options)
    return result.exit_code == 0, _object(result)


def blame(run_folder: PathLike, x: int, y: int, **options: Option) -> Dict[str, Any]:
    """Which steps of a run changed a pixel, and through what; 0, 0 is the upper left one.

    >>> [change["name"] for change in blame("runs/looks", 480, 270)["changes"]]  # doctest: +SKIP
    ['gold']
    """
    return _object(run("blame", run_folder, f"{x},{y}", json=True, **options))


def export(scene: PathLike, journal: PathLike, step: int, out: PathLike, **options: Option) -> Result:
    """Writes the scene with the edits up to a step as glTF, which renders to that step's frame.

    >>> export("shot.glb", "looks.json", 3, "look.glb")  # doctest: +SKIP
    """
    return run("export", scene, journal=journal, step=step, output=out, **options)


def sheet(run_folder: PathLike, out: PathLike, **options: Option) -> Result:
    """A labelled contact sheet of a run, .png or .exr.

    >>> sheet("runs/looks", "sheet.png")  # doctest: +SKIP
    """
    return run("sheet", run_folder, output=out, **options)


def page(run_folder: PathLike, out: PathLike, **options: Option) -> Result:
    """The page of a run as a single file, to send.

    >>> page("runs/looks", "looks.html")  # doctest: +SKIP
    """
    return run("report", run_folder, single_file=True, output=out, **options)


def journal_from(source: str, *inputs: PathLike, out: PathLike, **options: Option) -> Dict[str, Any]:
    """A journal made from scenes: `source` is diff, variants, animation, wedge ...

    >>> journal_from("diff", "v1.glb", "v2.glb", out="changes.json")["steps"]  # doctest: +SKIP
    1
    """
    return _object(run("journal " + source, *inputs, output=out, json=True, **options))


def _object(result: Result) -> Dict[str, Any]:
    content = result.json
    return content if isinstance(content, dict) else {}


# ---- Look documents


class Look:
    """The look document: what can be edited, by name.

    >>> look = Look({"lights": {"Key": {"intensity": 5, "color": [1, 1, 1]}}, "nodes": {}})
    >>> look["/lights/Key/color/0"], look.names("lights"), "/lights/Fill" in look
    (1, ['Key'], False)
    """

    def __init__(self, content: Dict[str, Any]):
        self.content = content

    @classmethod
    def of(cls, scene: PathLike, **options: Option) -> "Look":
        """Of a scene or cache.

        >>> Look.of("shot.glb").names("materials")  # doctest: +SKIP
        ['Case', 'Strap']
        """
        return cls(json.loads(run("inspect", scene, look=True, **options).output))

    def __getitem__(self, path: str) -> Any:
        value: Any = self.content
        for part in parts(path):
            try:
                value = value[int(part)] if isinstance(value, list) else value[part]
            except (KeyError, IndexError, ValueError, TypeError):
                raise KeyError(path) from None
        return value

    def __contains__(self, path: str) -> bool:
        try:
            self[path]
        except KeyError:
            return False
        return True

    def names(self, section: str, pattern: str = "*") -> List[str]:
        """Of "materials", "lights", "nodes" ..., those that a pattern matches.

        >>> Look({"materials": {"LeavesA": {}, "LeavesB": {}, "Bark": {}}}).names("materials", "Leaves*")
        ['LeavesA', 'LeavesB']
        """
        return [name for name in self.content.get(section, {}) if fnmatchcase(name, pattern)]

    def paths(self, pattern: str = "*") -> Iterator[Tuple[str, Any]]:
        """Pointers and values of all numbers, texts and truths below what a pattern matches.

        >>> list(Look({"lights": {"Key": {"color": [1, 0.5]}}}).paths("*/color/1"))
        [('/lights/Key/color/1', 0.5)]
        """
        return ((path, value) for path, value in _leaves("", self.content) if fnmatchcase(path, pattern))


def _leaves(path: str, value: Any) -> Iterator[Tuple[str, Any]]:
    if not isinstance(value, (dict, list)):
        yield path, value
        return
    for key, member in value.items() if isinstance(value, dict) else enumerate(value):
        yield from _leaves(path + pointer(key), member)


# ---- Reports


@dataclass
class Value:
    """What an axis of a wedge had in a frame: `text` is short, `value` None where it is long.

    >>> Value("/lights/Key/intensity", "key", "400", 400).text
    '400'
    """

    path: str
    label: str
    text: str
    value: Any = None


@dataclass
class Step:
    """An entry of a report: the frame before any step, a step, or one frame of a drag or wedge. `frame` and `preview`
    are files; `start` is the number of the step whose state it starts from (None: the base, or the report does not
    say); `differing` counts pixels that differ from a full render (None: not compared). `raw` has all else.

    >>> step = Step.of({"step": 2, "name": "key", "frame": "frames/0002_01.exr", "wedge_frame": 1}, Path("run"))
    >>> step.label, step.is_whole, str(step.frame)
    ('2_01', False, 'run/frames/0002_01.exr')
    """

    number: int
    name: str
    kind: str  # "base", "color", "optical", "geometric" or "mixed"
    frame: Path
    preview: Path
    reasons: List[str]
    pixels_changed: int
    samples_affected: int
    seconds: float
    drag_frame: Optional[int] = None
    wedge_frame: Optional[int] = None
    start: Optional[int] = None
    keep: bool = True
    values: List[Value] = field(default_factory=list)
    note: Optional[str] = None
    author: Optional[str] = None
    extras: Any = None
    differing: Optional[int] = None
    raw: Dict[str, Any] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, entry: Dict[str, Any], folder: Path) -> "Step":
        """Of an entry of report.json; what older programs did not write is None.

        >>> Step.of({"step": 1, "frame": "frames/0001.exr"}, Path("run")).note is None
        True
        """
        values = [Value(item.get("path", ""), item.get("label") or "", item.get("text", ""), item.get("value"))
                  for item in entry.get("values") or []]
        verify = entry.get("verify") or {}
        return cls(entry["step"], entry.get("name", ""), entry.get("class", ""), folder / entry.get("frame", ""),
                   folder / entry.get("preview", ""), list(entry.get("reasons", [])), entry.get("pixels_changed", 0),
                   entry.get("samples_affected", 0), entry.get("seconds", {}).get("total", 0.0),
                   entry.get("drag_frame"), entry.get("wedge_frame"), entry.get("from"), entry.get("keep", True),
                   values, entry.get("note"), entry.get("author"), entry.get("extras"),
                   verify.get("pixels_different"), entry)

    @property
    def label(self) -> str:
        """As frames are numbered: "3" for a step, "3_01" for a frame of its drag or wedge.

        >>> Step.of({"step": 3, "frame": "frames/0003.exr"}, Path()).label
        '3'
        """
        _, mark, frame = self.frame.stem.partition("_")
        return f"{self.number}{mark}{frame}" if not self.is_whole else str(self.number)

    @property
    def is_whole(self) -> bool:
        """Whether it stands for a step and not for one frame of a drag or wedge.

        >>> Step.of({"step": 3, "frame": "frames/0003_02.exr"}, Path()).is_whole
        True
        """
        return self.drag_frame is None and self.wedge_frame is None


@dataclass
class Report:
    """A run's report.json, and where its frames are.

    >>> report = Report.read("runs/looks")  # doctest: +SKIP
    >>> report.step("gold").frame  # doctest: +SKIP
    PosixPath('runs/looks/frames/0001.exr')
    """

    folder: Path
    program: str
    scene: str
    cache: str
    journal: str
    camera: str
    resolution: Tuple[int, int]
    samples: int
    noise: Optional[float]
    interrupted: bool
    steps: List[Step]
    note: Optional[str]
    author: Optional[str]
    extras: Any
    raw: Dict[str, Any] = field(repr=False)

    @classmethod
    def read(cls, run_folder: PathLike) -> "Report":
        """Of a run folder, or of its report.json. Of a run of several journals each folder in it has its own.

        >>> Report.read("runs/looks").samples  # doctest: +SKIP
        64
        """
        folder = Path(run_folder)
        folder = folder.parent if folder.name == "report.json" else folder
        try:
            raw = json.loads((folder / "report.json").read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            reason = error.strerror if isinstance(error, OSError) else "no JSON"
            raise FileError(6, [f"{folder / 'report.json'}: {reason}"]) from None
        if not str(raw.get("relook", "")).startswith("report/"):
            raise InputError(2, [f"{folder / 'report.json'}: no report of relook"])
        journal = raw["journal"]
        return cls(folder, raw["program"], raw["scene"]["file"], raw["cache"], journal["file"], raw["camera"],
                   (raw["resolution"][0], raw["resolution"][1]), raw["samples"], raw.get("noise"), raw["interrupted"],
                   [Step.of(entry, folder) for entry in raw["steps"]], journal.get("note"), journal.get("author"),
                   journal.get("extras"), raw)

    def step(self, which: Union[str, int]) -> Step:
        """By its label ("3_01"), its number, or its name, which must be the only one.

        >>> report.step("2_01").values[0].text  # doctest: +SKIP
        '100'
        """
        found = [entry for entry in self.steps if entry.label == str(which)]
        found = found or [entry for entry in self.steps if entry.is_whole and entry.name == which]
        if len(found) != 1:
            raise KeyError(f'{"no" if not found else "more than one"} step "{which}" in {self.folder}')
        return found[0]

    def frames(self) -> List[Step]:
        """One entry a file: without those of whole drags and wedges, which name their last frame again.

        >>> [entry.label for entry in report.frames()]  # doctest: +SKIP
        ['0', '1', '2_01', '2_02']
        """
        return [entry for entry in self.steps if not entry.is_whole or "_" not in entry.frame.stem]

    @property
    def is_exact(self) -> Optional[bool]:
        """Whether all frames equal full renders; None where not all were compared.

        >>> report.is_exact  # doctest: +SKIP
        True
        """
        if any(entry.differing is None for entry in self.steps):
            return None
        return all(entry.differing == 0 for entry in self.steps)


# ---- Picks


@dataclass
class Review:
    """What somebody thinks of a frame: 0 to 5 stars, "approved", "rejected" or "", a note. `label` as of Step.

    >>> Review("2_01", "key", stars=4, verdict="approved").label
    '2_01'
    """

    label: str
    name: str = ""
    stars: int = 0
    verdict: str = ""
    note: str = ""


@dataclass
class Reviews:
    """The notes that the page of a run exports and imports ("reviews/1").

    >>> reviews = Reviews([Review("1", "gold", 3), Review("2", stars=1, verdict="approved")])
    >>> [review.label for review in reviews.approved()]
    ['2']
    """

    steps: List[Review]
    scene: Dict[str, Any] = field(default_factory=dict)
    journal: Dict[str, Any] = field(default_factory=dict)

    @classmethod
    def read(cls, path: PathLike) -> "Reviews":
        """Of the file that the page exports.

        >>> best = Reviews.read("looks-notes.json").approved()[0]  # doctest: +SKIP
        >>> Report.read("runs/looks").step(best.label).frame  # doctest: +SKIP
        PosixPath('runs/looks/frames/0002_01.exr')
        """
        content = json.loads(Path(path).read_text(encoding="utf-8"))
        if not isinstance(content, dict) or content.get("relook") != "reviews/1":
            raise InputError(2, [f"{os.fspath(path)}: no notes of a page of relook"])
        steps = [Review(item["label"], item.get("name", ""), item.get("stars", 0), item.get("verdict", ""),
                        item.get("note", "")) for item in content["steps"]]
        return cls(steps, content.get("scene", {}), content.get("journal", {}))

    def write(self, path: PathLike) -> Path:
        """Writes them for the page to import.

        >>> Reviews([Review("1", note="as discussed")]).write("notes.json")  # doctest: +SKIP
        PosixPath('notes.json')
        """
        content = {"relook": "reviews/1", "scene": self.scene, "journal": self.journal,
                   "steps": [vars(review) for review in self.steps]}
        Path(path).write_text(json.dumps(content, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
        return Path(path)

    def approved(self) -> List[Review]:
        """Those approved, the most stars first.

        >>> Reviews([Review("1")]).approved()
        []
        """
        return sorted((step for step in self.steps if step.verdict == "approved"), key=lambda step: -step.stars)


# ---- Farms


def chunks(foreseen: Mapping[str, Any], seconds: float) -> List[str]:
    """Ranges for --steps that take about so many seconds each, from what plan() says.

    >>> chunks({"frames": [{"step": s, "seconds": 2.0} for s in (1, 2, 2, 3, 4)]}, 6)
    ['0-2', '3-4']
    """
    by_step: Dict[int, float] = {}
    for frame in foreseen["frames"]:
        by_step[frame["step"]] = by_step.get(frame["step"], 0.0) + frame["seconds"]
    ranges: List[str] = []
    first, taken = 0, 0.0
    for step in sorted(by_step):
        taken += by_step[step]
        if taken >= seconds or step == max(by_step):
            ranges.append(f"{first}-{step}")
            first, taken = step + 1, 0.0
    return ranges or ["0-0"]
