"""python3 validate.py SCHEMA FILES...: a line each, "ok" or what the schema refuses; exit 77 without jsonschema."""
import json
import sys

try:
    import jsonschema
except ImportError:
    sys.exit(77)

with open(sys.argv[1], encoding="utf-8") as file:
    schema = json.load(file)
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
for name in sys.argv[2:]:
    with open(name, encoding="utf-8") as file:
        error = next(validator.iter_errors(json.load(file)), None)
    place = "".join("/" + str(part) for part in error.absolute_path) if error else ""
    print("ok" if error is None else place + ": " + error.message.replace("\n", " ")[:200])
