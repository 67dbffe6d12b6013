"""Values drawn from a JSON schema as io/schema/write.cpp writes it, and tests of each of its statements."""

import itertools
import math

OTHERS = [None, True, False, "x", "infinity", -1, 0, 0.5, 3, 1e13, 1e39, -1e39, [], {}, [0, 0, 0], [1, 2], {"x": 1}]


def bounds(node):
    """The bounds of the numbers that a node accepts."""
    return [float(node[key]) for key in ("minimum", "exclusiveMinimum", "maximum", "exclusiveMaximum") if key in node]


def around(bound):
    """Values at a bound, just outside and inside it, and farther away."""
    return [bound, math.nextafter(bound, math.inf), math.nextafter(bound, -math.inf), bound + 1, bound - 1, 2 * bound]


def clauses(node, keys):
    """The clauses for an object with these keys: those that the keys require, then the choice among them."""
    for key, clause in node.get("dependentSchemas", {}).items():
        if key in keys:
            yield from clauses(clause, keys)
    for clause in node.get("allOf", []):
        yield from clauses(clause, keys)
    yield node


def alternatives(clause):
    """The keys of each choice that a clause allows, "key/inner" for a key of the object under a key; empty for the choice of none."""
    for choice in clause.get("oneOf", []) + clause.get("anyOf", []):
        under = [f"{key}/{inner}" for key, node in choice.get("properties", {}).items() for inner in node["required"]]
        yield choice.get("required", []) + under


def is_flat(keys):
    return not any("/" in key for key in keys)


def element(node):
    """The schema of the members whose names the user chooses; None for an object with fixed keys."""
    inner = node.get("additionalProperties")
    return inner if isinstance(inner, dict) else None


def members(node, owners=()):
    """The keys of an object: those that make each available, the key and its schema."""
    for key, inner in node.get("properties", {}).items():
        if inner is not True:
            yield owners, key, inner
    for clause in node.get("allOf", []):
        yield from members(clause, owners)
    for owner, clause in node.get("dependentSchemas", {}).items():
        yield from members(clause, owners + (owner,))


class Samples:
    """Draws values of one schema with one random number generator."""

    def __init__(self, schema, draw):
        self.schema = schema
        self.draw = draw

    def resolved(self, node):
        return self.schema["$defs"][node["$ref"].split("/")[-1]] if "$ref" in node else node

    def of(self, node):
        """A value that a node accepts."""
        node = self.resolved(node)
        if "enum" in node:
            return self.draw.choice(node["enum"])
        if "type" not in node:
            return self.of(self.draw.choice(node["anyOf"]))
        return getattr(self, node["type"])(node)

    def null(self, node):
        return None

    def boolean(self, node):
        return self.draw.random() < 0.5

    def string(self, node):
        return "x"

    def number(self, node):
        low, high = bounds(node)
        near = [x for x in (0, 0.5, 1, 2, 3, 500) if low < x < high]
        return self.draw.choice(near + [node[key] for key in ("minimum", "maximum") if key in node])

    def integer(self, node):
        low, high = bounds(node)
        return self.draw.choice([x for x in (1, 2, 3, low, high) if low <= x <= high])

    def array(self, node, length=None):
        if "prefixItems" in node:
            length = self.draw.randint(node["minItems"], node["maxItems"]) if length is None else length
            return [self.of(inner) for inner in node["prefixItems"][:length]] + [None] * (length - node["maxItems"])
        length = node.get("minItems", self.draw.randrange(3)) if length is None else length
        return [self.of(node["items"]) for _ in range(length)]

    def object(self, node, keys=(), flat=False):
        """An object with at least these keys; `flat` allows only choices that demand nothing under a key."""
        if element(node):
            return {"a": self.of(element(node))}
        keys = dict.fromkeys(keys)
        grown = -1
        while grown < len(keys):
            grown = len(keys)
            for clause in clauses(node, list(keys)):
                keys.update(dict.fromkeys(clause.get("required", [])))
                choices = list(alternatives(clause))
                if choices and not any(keys.keys() >= set(choice) for choice in choices):
                    fitting = [choice for choice in choices if not flat or is_flat(choice)]
                    keys.update(dict.fromkeys(self.draw.choice(fitting)))
        schemas = {key: inner for owners, key, inner in members(node) if keys.keys() >= set(owners)}
        return {key: self.with_keys(schemas[key], [path.split("/")[1] for path in keys if path.startswith(key + "/")])
                for key in keys if "/" not in key}

    def with_keys(self, node, keys):
        return self.object(self.resolved(node), keys) if keys else self.of(node)

    def sites(self, node, wrap=lambda value: value, seen=None):
        """Every node of the schema once, with a function that embeds a value for it in a whole scene."""
        seen = set() if seen is None else seen
        if node.get("$ref") in seen:
            return
        seen.update([node["$ref"]] if "$ref" in node else [])
        node = self.resolved(node)
        yield node, wrap
        if "type" not in node:
            for form in node.get("anyOf", []):
                yield from self.sites(form, wrap, seen)
        elif "prefixItems" in node:
            for place, inner in enumerate(node["prefixItems"]):
                row = lambda value, at=place: wrap([*self.array(node, at), value, *self.array(node)[at + 1:]])
                yield from self.sites(inner, row, seen)
        elif node["type"] == "array":
            rest = node.get("minItems", 1) - 1
            yield from self.sites(node["items"], lambda value: wrap([value] + self.array(node, rest)), seen)
        elif node["type"] == "object" and element(node):
            yield from self.sites(element(node), lambda value: wrap({"a": value}), seen)
        elif node["type"] == "object":
            for owners, key, inner in members(node):
                place = lambda value, keys=(*owners, key): wrap({**self.object(node, keys, flat=True), keys[-1]: value})
                yield from self.sites(inner, place, seen)

    def probes(self, node):
        """Values that a node accepts and values that it rejects, for each of its statements."""
        yield from self.draw.sample(OTHERS, 3)
        yield from (value for bound in bounds(node) for value in around(bound))
        yield from (*node.get("enum", []), "unheard_of")
        if node.get("type") == "array":
            least, most = node.get("minItems", 0), node.get("maxItems", 3)
            yield from (self.array(node, length) for length in range(max(0, least - 1), most + 2))
            yield [0] * least
        if node.get("type") == "object" and not element(node):
            yield from self.object_probes(node)

    def object_probes(self, node):
        """Objects that lack a key, that have an extra key, and that have mutually exclusive keys."""
        yield {**self.object(node), "unheard_of": 1}
        for owners, key, inner in members(node):
            whole = self.object(node, (*owners, key))
            yield whole
            yield {**self.object(node), key: self.of(inner)}
            yield from ({other: whole[other] for other in whole if other != left_out} for left_out in whole)
        for clause in clauses(node, [key for _, key, _ in members(node)]):
            for one, other in itertools.combinations(alternatives(clause), 2):
                yield self.object(node, one + other)
