"""Small changes of Rust sources, all of them compiled into one program, of which each run has one.

A change stands beside what it replaces: `a < b` becomes `(if is(7) { a <= b } else { a < b })`, so
that a thousand changes need one build (mutant schemata: Untch, Offutt and Harrold, Mutation Analysis
Using Mutant Schemata, ISSTA 1993).
"""

from dataclasses import dataclass

import tree_sitter_rust
from tree_sitter import Language, Parser

PARSER = Parser(Language(tree_sitter_rust.language()))

OPERATORS = {
    "<": ["<=", ">="], "<=": ["<", ">"], ">": [">=", "<="], ">=": [">", "<"],
    "==": ["!="], "!=": ["=="], "&&": ["||"], "||": ["&&"],
    "+": ["-"], "-": ["+"], "*": ["/"], "/": ["*"], "%": ["*"],
    "+=": ["-="], "-=": ["+="], "*=": ["/="], "/=": ["*="],
}
METHODS = {
    "min": ["max"], "max": ["min"], "any": ["all"], "all": ["any"],
    "next_up": ["next_down", None], "next_down": ["next_up", None],
    "is_some": ["is_none"], "is_none": ["is_some"], "abs": [None], "floor": ["ceil"], "ceil": ["floor"],
    "is_some_and": ["is_none_or"], "is_none_or": ["is_some_and"], "transpose": [None],
}
DEFAULTS = {"bool": ["true", "false"], "f64": ["0.0"], "usize": ["0"], "u64": ["0"]}
# What is evaluated by the compiler, or is no expression.
OPAQUE = {
    "const_item", "static_item", "attribute_item", "inner_attribute_item", "macro_invocation",
    "macro_definition", "type_arguments", "array_type", "use_declaration", "line_comment",
}
SWITCH = "crate::mutation::is"


@dataclass
class Change:
    """One change of one place."""

    path: str
    line: int
    before: str
    after: str
    place: tuple
    number: int = 0

    def __str__(self):
        return f"{self.path}:{self.line}  {self.before}  ->  {self.after}"


def text(node):
    return node.text.decode()


def short(words, most=100):
    words = " ".join(words.split())
    return words if len(words) <= most else words[: most - 3] + "..."


def is_test(item):
    before = item.prev_named_sibling
    while before is not None and before.type in ("attribute_item", "line_comment"):
        if "cfg(test)" in text(before) or text(before) == "#[test]":
            return True
        before = before.prev_named_sibling
    return False


def places(node):
    """The nodes that a change may replace, from the outside inwards."""
    if node.type in OPAQUE or node.type in ("mod_item", "function_item") and is_test(node):
        return
    if node.type == "function_item" and text(node).split("fn", 1)[0].find("const") >= 0:
        return
    yield node
    for child in node.children:
        yield from places(child)


def replacements(node):
    """What may stand at a place instead, in words and as code."""
    if node.type in ("binary_expression", "compound_assignment_expr"):
        left, sign, right = node.children[0], node.children[1], node.children[2]
        for other in OPERATORS.get(text(sign), []):
            yield f"{text(left)} {text(sign)} {text(right)}", f"{text(left)} {other} {text(right)}"
    elif node.type == "unary_expression" and text(node)[0] in "-!":
        yield text(node), text(node)[1:]
    elif node.type == "call_expression" and node.children[0].type == "field_expression":
        receiver, name = node.children[0].children[0], text(node.children[0].children[-1])
        for other in METHODS.get(name, []):
            changed = text(receiver)
            if other is not None:
                changed += f".{other}{text(node.children[1])}"
            yield text(node), changed
    elif node.type == "expression_statement":
        inner = node.children[0].type
        if inner in ("call_expression", "assignment_expression", "compound_assignment_expr", "try_expression"):
            yield text(node), "{}"
    elif node.type == "if_expression":
        condition = node.child_by_field_name("condition")
        if not condition.type.startswith("let"):
            yield f"if {text(condition)}", f"if !({text(condition)})"
    elif node.type == "function_item":
        kind = node.child_by_field_name("return_type")
        body = node.child_by_field_name("body")
        if kind is not None and body is not None and body.named_child_count:
            name = text(kind)
            values = DEFAULTS.get(name, ["None"] if name.startswith("Option<") else [])
            values = values or (["Vec::new()"] if name.startswith("Vec<") else [])
            for value in values:
                yield f"fn {text(node.child_by_field_name('name'))}", f"return {value}"


def changes(path, source):
    """All changes of a file."""
    root = PARSER.parse(source).root_node
    for node in places(root):
        for before, after in replacements(node):
            if "//" in after:
                continue
            inside = node.child_by_field_name("body") if node.type == "function_item" else node
            # On one line, so that the compiler's complaints lead back to the change.
            after = " ".join(after.split())
            place = node.start_byte, node.end_byte, node.type, after
            shown = "(removed)" if after == "{}" else short(after)
            yield Change(path, inside.start_point[0] + 1, short(before), shown, place)


def rewritten(source, chosen):
    """The source with these changes built in."""
    at = {}
    for change in chosen:
        start, end, kind, after = change.place
        at.setdefault((start, end, kind), []).append((change.number, after))

    def emit(node):
        known = at.get((node.start_byte, node.end_byte, node.type), [])
        if node.type == "function_item" and known:
            body = node.child_by_field_name("body")
            head = source[node.start_byte : body.start_byte].decode()
            returns = "".join(f"if {SWITCH}({n}) {{ {after}; }} " for n, after in known)
            return head + "{ " + returns + whole(body)[1:]
        if node.type == "if_expression" and known:
            condition = node.child_by_field_name("condition")
            flipped = emit(condition)
            for number, _ in known:
                # One that is not chosen changes nothing.
                flipped = f"({SWITCH}({number}) != ({flipped}))"
            return pieces(node, {condition.id: flipped})
        usual = whole(node)
        for number, after in known:
            if node.type == "expression_statement":
                usual = f"if !{SWITCH}({number}) {{ {usual} }}"
            elif node.type == "compound_assignment_expr":
                usual = f"if {SWITCH}({number}) {{ {after} }} else {{ {usual} }}"
            else:
                usual = f"(if {SWITCH}({number}) {{ {after} }} else {{ {usual} }})"
        return usual

    def whole(node):
        return pieces(node, {})

    def pieces(node, given):
        if not node.children:
            return source[node.start_byte : node.end_byte].decode()
        out, place = [], node.start_byte
        for child in node.children:
            out.append(source[place : child.start_byte].decode())
            out.append(given[child.id] if child.id in given else emit(child))
            place = child.end_byte
        out.append(source[place : node.end_byte].decode())
        return "".join(out)

    root = PARSER.parse(source).root_node
    assert not root.has_error
    lead = source[: root.start_byte].decode()
    return lead + emit(root) + source[root.end_byte :].decode()
