"""Compares docs/reference/scene.schema.json with the scene reader, by the validator of Debian's python3-jsonschema.

schema_agreement.py SCENE_VERDICTS SCHEMA

Every scene of the tree, every example of the guide, mutations of them and probes of each thing that the schema says must get the
same verdict of both; scenes and examples must be valid. The seed is fixed.
"""

import collections
import copy
import functools
import json
import os
import random
import subprocess
import sys

try:
    import jsonschema
except ImportError:
    print("skipped: needs the Debian package python3-jsonschema")
    sys.exit(77)

from schema_samples import OTHERS, Samples, around, bounds, members

MUTANTS = 2000 if "ABBE_NIGHTLY" in os.environ else 500
LEAST_OF_EACH = 500  # valid ones and invalid ones, without which agreement would say little
MOST_COMPLAINTS = 20

PROGRAM, SCHEMA_FILE = sys.argv[1:]
with open(SCHEMA_FILE, encoding="utf-8") as file:
    SCHEMA = json.load(file)
draw = random.Random(12)
samples = Samples(SCHEMA, draw)


def walk(value, path=()):
    """Yields every value within a JSON value, with its path."""
    yield path, value
    within = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in within:
        yield from walk(inner, path + (key,))


def key_of(path):
    """The last key on a path; elements of an array have the key of the array."""
    return next((step for step in reversed(path) if isinstance(step, str)), "")


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def run(*arguments, text=None):
    return subprocess.run([PROGRAM, *arguments], input=text, capture_output=True, text=True, check=True).stdout.splitlines()


# The scenes. For each key: where it occurs (number of the scene and path), and its values there.
SCENES = [json.loads(line) for line in run("examples")]
PLACES = collections.defaultdict(list)
VALUES = collections.defaultdict(list)
for number, scene in enumerate(SCENES):
    for path, value in list(walk(scene))[1:]:
        PLACES[key_of(path)].append((number, path))
        VALUES[key_of(path)].append(value)
KEYS = sorted(PLACES)

# The schema's statements about the keys of each object, about a key wherever it occurs, and about mutually exclusive keys.
OBJECTS = [dict((key, inner) for _, key, inner in members(node))
           for _, node in walk(SCHEMA) if isinstance(node, dict) and node.get("type") == "object"]
NODES = collections.defaultdict(list)
for known in OBJECTS:
    for name, inner in known.items():
        NODES[name].append(inner)
GROUPS = [[key for choice in node["oneOf"] for key in choice.get("required", [])]
          for _, node in walk(SCHEMA) if isinstance(node, dict) and "oneOf" in node]


def nearby(node):
    """The bounds of numbers right at a node of the schema, in its forms and in arrays there."""
    node = samples.resolved(node)
    inner = node.get("anyOf", []) + node.get("prefixItems", []) + ([node["items"]] if "items" in node else [])
    return bounds(node) + [bound for part in inner for bound in nearby(part)]


# The mutations of the value `at` a key or index of `parent` in `scene`, whose key is `key`. They return False if they do not apply.
def drop(parent, at, key, scene):
    del parent[at]


def misspell(parent, at, key, scene):
    if not isinstance(at, str):
        return False
    parent[draw.choice([at + "s", at[:-1], at.upper(), at[1:] + at[0]])] = parent.pop(at)


def add_unknown_key(parent, at, key, scene):
    if not isinstance(parent[at], dict):
        return False
    parent[at][draw.choice(["unheard_of", "name", "$schema", draw.choice(KEYS)])] = draw.choice(OTHERS)


def change_type(parent, at, key, scene):
    parent[at] = draw.choice(OTHERS)


def scale_number(parent, at, key, scene):
    if not is_number(parent[at]):
        return False
    parent[at] = draw.choice([-parent[at], parent[at] * 1e6, parent[at] / 1e3, parent[at] + 0.5, 0, 200, 1e5, 1e12, 1e31, -1e31])


def go_to_bound(parent, at, key, scene):
    near = sorted({bound for node in NODES[key] for bound in nearby(node)})
    if not is_number(parent[at]) or not near:
        return False
    parent[at] = draw.choice(around(draw.choice(near)))


def exchange(parent, at, key, scene):
    path, _ = draw.choice(list(walk(scene))[1:])
    other, there = functools.reduce(lambda value, step: value[step], path[:-1], scene), path[-1]
    parent[at], other[there] = copy.deepcopy(other[there]), copy.deepcopy(parent[at])


def take_from_elsewhere(parent, at, key, scene):
    parent[at] = copy.deepcopy(draw.choice(VALUES[draw.choice([key, draw.choice(KEYS)])] or [1]))


def empty(parent, at, key, scene):
    if not isinstance(parent[at], (list, dict)):
        return False
    parent[at] = type(parent[at])()


def lengthen(parent, at, key, scene):
    if not isinstance(parent, list):
        return False
    parent.append(copy.deepcopy(parent[at]))


def sample_anew(parent, at, key, scene):
    if not NODES[key] or not isinstance(at, str):
        return False
    parent[at] = samples.of(draw.choice(NODES[key]))


def add_known_key(parent, at, key, scene):
    fitting = [known for known in OBJECTS if isinstance(parent, dict) and known.keys() > parent.keys()]
    if not fitting:
        return False
    known = draw.choice(fitting)
    added = draw.choice([other for other in known if other not in parent])
    parent[added] = samples.of(known[added])


def add_alternative(parent, at, key, scene):
    groups = [group for group in GROUPS if at in group and len(group) > 1]
    if not groups:
        return False
    other = draw.choice([other for other in draw.choice(groups) if other != at])
    if draw.random() < 0.5:
        del parent[at]
    parent[other] = samples.of(draw.choice(NODES[other]))


MUTATIONS = [drop, misspell, add_unknown_key, change_type, scale_number, go_to_bound, exchange, take_from_elsewhere, empty, lengthen,
             sample_anew, add_known_key, add_alternative]


def mutant():
    """A scene with one mutation, and its name; rare and frequent keys are drawn equally often."""
    mutation = draw.choice(MUTATIONS)
    while True:
        number, path = draw.choice(PLACES[draw.choice(KEYS)])
        scene = copy.deepcopy(SCENES[number])
        parent = functools.reduce(lambda value, step: value[step], path[:-1], scene)
        if mutation(parent, path[-1], key_of(path), scene) is not False:
            return mutation.__name__, scene


def tell(kind, scene, verdict, validator):
    """The verdicts of schema and reader on a scene."""
    error = jsonschema.exceptions.best_match(validator.iter_errors(scene))
    said = f"/{'/'.join(map(str, error.absolute_path))}: {error.message[:300]}" if error else "ok"
    print(f"{kind}: the reader says {verdict}\n  the schema says {said}\n  {json.dumps(scene)[:2000]}")


def compare(cases, validator):
    """Numbers of cases of each kind: all, valid, and those on which both agree."""
    verdicts = run(text="".join(json.dumps(scene) + "\n" for _, scene in cases))
    figures = collections.defaultdict(collections.Counter)
    complaints = 0
    for (kind, scene), verdict in zip(cases, verdicts, strict=True):
        valid = validator.is_valid(scene)
        agreed = valid == (verdict == "ok")
        for row in (kind, "all"):
            figures[row].update({"cases": 1, "valid": valid, "invalid": not valid, "agreed": agreed})
        complaints += not agreed
        if not agreed and complaints <= MOST_COMPLAINTS:
            tell(kind, scene, verdict, validator)
    return figures


def main():
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    cases = [("as it is", scene) for scene in SCENES] + [mutant() for _ in range(MUTANTS)]
    cases += [("probe", wrap(value)) for node, wrap in samples.sites(SCHEMA) for value in samples.probes(node)]
    figures = compare(cases, jsonschema.Draft202012Validator(SCHEMA))
    for kind, figure in sorted(figures.items()):
        print(f"{kind:20}" + "".join(f"{figure[what]:6} {what}" for what in ("cases", "valid", "invalid", "agreed")))
    every = figures["all"]
    enough = min(every["valid"], every["invalid"]) >= LEAST_OF_EACH
    return 0 if enough and figures["as it is"]["valid"] == len(SCENES) and every["agreed"] == every["cases"] else 1


if __name__ == "__main__":
    sys.exit(main())
