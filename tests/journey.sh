#!/bin/sh
# A newcomer's way from a .glb to a chosen look, with what README.md says and nothing else: install, look around, write a
# journal of options, foresee, replay, look at the page, pick, export, and render what was exported. Part of ctest.
#
# usage: sh tests/journey.sh [BUILD]      build/release; all else goes to a temporary folder, which is removed
# What is not at hand here (a browser) is skipped, and said. Exit code 1 at the first thing that is not as it should be.
set -eu
sources=$(cd "$(dirname "$0")/.." && pwd)
build=$(cd "${1:-$sources/build/release}" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

say() { echo "== $*"; }
fail() { echo "journey: $*" >&2; exit 1; }
# expect FILE WORDS: the words stand in the file.
expect() { grep -qF -- "$2" "$1" || { cat "$1" >&2; fail "no \"$2\" in what was printed"; }; }
# knows WORDS: the program has this verb, or says that it is left out.
knows() {
  relook "$@" --help >/dev/null 2>&1 || { echo "SKIPPED: this program has no \`relook $*\`"; return 1; }
}

say "install"
cmake --install "$build" --prefix "$folder/usr" >install.txt
PATH="$folder/usr/bin:$PATH"
export PATH
unset RELOOK
relook --version >version.txt
expect version.txt "relook "
relook --version --json | python3 -c 'import json, sys; assert json.load(sys.stdin)["features"]["images"]'
for file in share/man/man1/relook.1.gz share/bash-completion/completions/relook share/relook/python/relook.py \
  share/relook/schemas/report.schema.json share/relook/examples/journals/product-lights.json; do
  [ -s "usr/$file" ] || fail "not installed: $file"
done

say "what is in it?"
cp usr/share/relook/examples/journals/files/obelisk.glb shot.glb
relook inspect shot.glb >inspect.txt
expect inspect.txt "1 materials"
if relook inspect --help | grep -q -- --paths; then
  relook inspect shot.glb --paths Copper >paths.txt
  expect paths.txt "/materials/Copper/pbrMetallicRoughness/roughnessFactor = "
else
  echo "SKIPPED: this program has no \`relook inspect --paths\`"
fi

say "a cache of one view"
view="--camera auto --lights auto --resolution 160x90 --samples 16"
relook preprocess shot.glb -o shot.cache $view >preprocess.txt
expect preprocess.txt "noise"

say "a journal: two options to the scene as it is, values to choose from, a grid"
cat >looks.json <<'END'
{ "relook": "journal/1", "note": "which metal, and how bright a key?",
  "steps": [
    { "name": "gold", "from": "base", "note": "as the client asked",
      "edit": [ {"op": "replace", "path": "/materials/Copper/pbrMetallicRoughness/baseColorFactor", "value": [1, 0.77, 0.34, 1]} ] },
    { "name": "dull gold", "from": "gold",
      "edit": [ {"op": "replace", "path": "/materials/Cop*/pbrMetallicRoughness/roughnessFactor", "value": 0.5} ] },
    { "name": "steel", "from": "base",
      "edit": [ {"op": "replace", "path": "/materials/Copper/pbrMetallicRoughness/baseColorFactor", "value": [0.6, 0.6, 0.62, 1]} ] },
    { "name": "how bright?", "from": "gold", "keep": false,
      "wedge": {"path": "/lights/key/intensity", "label": "key", "range": {"from": 1, "to": 8, "count": 4, "scale": "log"}} },
    { "name": "key against rim", "from": "gold", "keep": false,
      "wedge": [ {"path": "/lights/key/intensity", "values": [1, 4]},
                 {"path": "/lights/rim/intensity", "values": [0, 4], "labels": ["none", "strong"]} ] } ] }
END
sed 's/Copper/Coper/' looks.json >slip.json
if relook inspect slip.json --scene shot.cache 2>slip.txt; then fail "a slip was not found"; fi
expect slip.txt 'did you mean "Copper"?'
relook inspect looks.json --scene shot.cache >classes.txt
expect classes.txt "gold"
relook plan shot.cache looks.json >plan.txt
expect plan.txt "how bright?"

say "replay, each frame held against a full render"
relook replay shot.cache looks.json -o runs/looks --verify >replay.txt
expect replay.txt "verified: 0 of"
[ "$(ls runs/looks/frames | wc -l)" -eq 12 ] || fail "12 frames were asked for"
relook replay shot.cache looks.json -o runs/looks >again.txt
expect again.txt "complete"

say "the page"
[ "$(wc -c <runs/looks/report.html)" -lt 5000000 ] || fail "report.html is too large"
if command -v chromium >/dev/null; then
  chromium --headless=new --no-sandbox --disable-gpu --disable-dev-shm-usage --user-data-dir="$folder/browser" \
    --virtual-time-budget=4000 --dump-dom "file://$folder/runs/looks/report.html" >page.txt 2>browser.txt
  for step in "dull gold" steel "key against rim"; do expect page.txt "$step"; done
else
  echo "SKIPPED: no chromium: the page is not opened"
fi

say "to show others"
if knows sheet; then
  relook sheet runs/looks -o sheet.png >sheet.txt
  [ -s sheet.png ] || fail "no sheet"
fi
if knows report; then
  relook report runs/looks --single-file -o looks.html >single.txt
  [ -s looks.html ] || fail "no single file"
fi

say "the pick, from the notes that the page exports"
cat >looks-notes.json <<'END'
{"relook": "reviews/1", "scene": {}, "journal": {}, "steps": [
  {"label": "1", "name": "gold", "stars": 3, "verdict": "", "note": ""},
  {"label": "2", "name": "dull gold", "stars": 5, "verdict": "approved", "note": "this one"}]}
END
PYTHONPATH=usr/share/relook/python PYTHONDONTWRITEBYTECODE=1 python3 - >pick.txt <<'END'
import relook
pick = relook.Report.read("runs/looks").step(relook.Reviews.read("looks-notes.json").approved()[0].label)
print(pick.number, pick.frame)
END
read -r step frame <pick.txt
[ "$step $frame" = "2 runs/looks/frames/0002.exr" ] || fail "another pick: $step $frame"

say "the look, without the journal: from the scene, and exported"
relook render shot.glb -o rendered.exr $view --journal looks.json --step "$step" >render.txt
relook compare rendered.exr "$frame" --exact >compare.txt || { cat compare.txt >&2; fail "render and replay differ"; }
if knows export; then
  relook export shot.cache --journal looks.json --step "$step" -o look.glb >export.txt
  relook render look.glb -o exported.exr --camera auto --resolution 160x90 --samples 16 >render.txt
  relook compare exported.exr "$frame" --exact >compare.txt || { cat compare.txt >&2; fail "the exported look differs"; }
fi
say "done"
