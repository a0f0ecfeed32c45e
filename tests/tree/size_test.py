#!/usr/bin/env python3
"""No function of more than 60 lines, no class of more than 25 member functions: what is larger is cut where a reader would cut it.

    python3 tests/tree/size_test.py [SOURCE]

Every C++ file is read for its braces. What stands before one tells namespaces, classes and functions from all else, without a compiler, since the files are
as clang-format leaves them: a body's brace has a space before it, an initialiser's has none. A function's lines run from its first one (`template` or its
return type) to its closing brace, with the lambdas in it. A class's member functions are those that it declares or defines itself, constructors
included, friends and deleted ones not. Tests' classes may have more.
"""
import re
import sys
import tempfile
from pathlib import Path

FOLDERS = ("framework", "plugins", "tools", "tests")
MAX_LINES, MAX_MEMBERS, MAX_EXCEPTIONS = 60, 25, 3

# (file, name) of what may be larger, and why. One that is no longer larger is told, too.
EXCEPTIONS = {
    ("framework/plumb/engine/run/step_run.hpp", "StepRun"):
        "one step in one pass for all kinds of steps; it is being cut into a class for each kind",
}

# Comments, literals and directives, which may hold braces of their own; a ' between digits parts them.
NO_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:[^"\\\n]|\\.)*"|(?<![0-9a-fA-F])\'(?:[^\'\\\n]|\\.)+\'|^[ \t]*#(?:[^\n\\]|\\.)*',
                     re.S | re.M)
ACCESS = r"\b(?:public|private|protected)\s*:"
CLASS = re.compile(r"\b(?:class|struct|union)\s+(?:alignas\([^)]*\)\s*)?([\w:]+)")
FUNCTION = re.compile(r"(operator\s*[^\s\w(]+|operator\s*\(\)|operator\s+[\w:&* ]+|~?\w+)\s*\(")
NO_FUNCTION = re.compile(r"^(?:using|typedef|friend|static_assert|return|if|else|for|while|do|switch|case|try|catch)\b")


def blanked(text):
    """The text with spaces for all that is no code, so that lines stay where they are."""
    return NO_CODE.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)


def bare(head):
    """What stands before a body or a semicolon, without access, attributes and what angle brackets hold: `std::function<void()> f;` is no function."""
    head = re.sub(r"\boperator\s*(?:<=>|<<|>>|<=|>=|->|<|>)=?", "operator~", re.sub(ACCESS, " ", head))
    head = re.sub(r"->|[<>]=", " ", head)
    while (shorter := re.sub(r"<[^<>]*>", " ", head)) != head:
        head = shorter
    return re.sub(r"^(?:\s*template\b)+", "", re.sub(r"\[\[.*?\]\]", " ", head)).strip()


def function_in(head):
    """The name of the function that `head` declares, or None."""
    head = bare(head)
    found = FUNCTION.search(head)
    if not found or NO_FUNCTION.match(head) or "=" in head[:found.start()]:
        return None
    return found[1]


class Scope:
    def __init__(self, kind, name="", line=1):
        self.kind, self.name, self.line, self.members = kind, name, line, 0


def opened(head, around, line):
    """The scope that a brace after `head` opens in the scope `around`."""
    plain = bare(head)
    if around.kind not in ("namespace", "class") or re.search(r"\benum\b", plain):
        return Scope("other")
    if re.search(r"\bnamespace\b|^extern$", plain):
        return Scope("namespace")
    found = CLASS.search(plain)
    if found and "(" not in plain[:found.start()]:
        return Scope("class", found[1], line)
    if name := function_in(head):
        around.members += 1
        return Scope("function", name, line)
    return Scope("other")


def sizes(text):
    """(kind, name, first line, size) of every function (its lines) and class (its member functions)."""
    code = blanked(text)
    scopes, begin, parentheses, initialisers = [Scope("namespace")], 0, 0, 0
    for found in re.finditer(r"[(){};]", code):
        mark, at = found[0], found.start()
        if mark in "()":
            parentheses += 1 if mark == "(" else -1
        elif mark == "{" and (initialisers or parentheses or code[at - 1] not in " \n" or code[:at].rstrip().endswith(("=", "return"))):
            initialisers += 1
        elif mark == "}" and initialisers:
            initialisers -= 1
        elif parentheses or initialisers:
            pass  # a lambda's statement in an argument
        else:
            head = code[begin:at]
            if mark == "{":
                first = begin + len(head) - len(re.sub(rf"^(?:\s|{ACCESS})+", "", head))
                scopes.append(opened(head, scopes[-1], code.count("\n", 0, first) + 1))
            elif mark == ";" and scopes[-1].kind == "class":
                scopes[-1].members += function_in(head) is not None and not re.search(r"=\s*delete$", head.rstrip())
            elif mark == "}":
                scope = scopes.pop()
                if scope.kind == "function":
                    yield scope.kind, scope.name, scope.line, code.count("\n", 0, at) + 2 - scope.line
                elif scope.kind == "class":
                    yield scope.kind, scope.name, scope.line, scope.members
            begin = at + 1
    assert len(scopes) == 1 and not parentheses and not initialisers, "braces that do not close"


def for_tests(path):
    return path.parts[0] == "tests" or path.name.endswith(("_test.cpp", "testing.hpp")) or "testing" in path.parts[:-1]


def too_large(source):
    """(file, name, sentence) of each function and class that is."""
    for part in FOLDERS:
        for file in sorted((source / part).rglob("*.[ch]pp")):
            path = file.relative_to(source)
            for kind, name, line, size in sizes(file.read_text()):
                if kind == "function" and size > MAX_LINES:
                    yield str(path), name, f"{path}:{line}: {name}() has {size} lines, more than {MAX_LINES}"
                elif kind == "class" and size > MAX_MEMBERS and not for_tests(path):
                    yield str(path), name, f"{path}:{line}: {name} has {size} member functions, more than {MAX_MEMBERS}"


def faults_of(source, exceptions):
    found = list(too_large(source))
    names = {(file, name) for file, name, _ in found}
    return [*(sentence for file, name, sentence in found if (file, name) not in exceptions),
            *(f"{file}: {name} is no longer too large: take it off the exceptions" for file, name in exceptions if (file, name) not in names),
            *([f"{len(exceptions)} exceptions, more than {MAX_EXCEPTIONS}"] if len(exceptions) > MAX_EXCEPTIONS else [])]


def sees_what_is_wrong():
    """The judge itself, on made-up files just within the bounds and just beyond them."""
    def function(lines, head="int f(int a) {"):
        return head + "\n" + "  a += 1;\n" * (lines - 2) + "}\n"

    def a_class(members, more=""):
        return "class A : public B<int (*)()> {\n public:\n  explicit A(int a) : a_(a), b_{1} {\n    if (a) {\n    }\n  }\n" + \
               "  int f(int a = 1) const;\n" * (members - 2) + "  bool operator<(const A& b) const { return a_ < b.a_; }\n" + more + \
               "\n private:\n  std::function<void(int)> g_;\n  int a_ = int(1), b_ = {};\n};\n"

    no_members = "  A(const A&) = delete;\n  friend void h(A& a);\n  using T = int(int);\n  enum class E { one, two };\n  struct C {\n    int f();\n  };\n"
    heads = ["template <class T>\nrequires C<T>\nstatic auto A<T>::f(T a) -> std::vector<T> {", "A::A(int a)\n    : a_(a), b_{a, {a}}, c_([] { return 1; }) {",
             "TEST(A, B) {", 'extern "C" int f(int a) {', "bool operator()(const A& a) const noexcept {", "std::function<int(int)> f() {"]
    tricks = ["namespace a {\n%s}\n", "// {\n/* } */\n#define A {\n%s", "const char *a = \"{\", b = '{', *c = R\"(\n}{\n)\";\n%s", "enum class E { one };\n%s",
              "const auto g = [](int a) { return a; };\nint h[] = {1'000, 2};\n%s", "struct B {\n%s};\n"]
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder)

        def faults(text, name="plugins/a/b.cpp", exceptions=()):
            file = source / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
            found = faults_of(source, exceptions)
            file.unlink()
            return found

        for trick in tricks:
            assert faults(trick % function(60)) == [], trick
            found = faults(trick % function(61))
            assert len(found) == 1 and "f() has 61 lines" in found[0], (trick, found)
        for head in heads:
            lines = 60 - head.count("\n")
            assert faults(function(lines, head)) == [], head
            found = faults(function(lines + 1, head))
            assert len(found) == 1 and "plugins/a/b.cpp:1:" in found[0] and "has 61 lines" in found[0], (head, found)
        assert len(faults(function(61), "tests/a/b.cpp")) == 1
        for lines, count in ((28, 0), (29, 1)):  # in it a lambda and a loop
            body = function(30, "  const auto g = [](int a) {")[:-1] + ";\n" + function(lines, "  for (;;) {")
            assert len(faults("void f() {\n" + body + "}\n")) == count, lines

        assert faults(a_class(25, no_members)) == [], faults(a_class(25, no_members))
        assert [*faults(a_class(26))] == ["plugins/a/b.cpp:1: A has 26 member functions, more than 25"], faults(a_class(26))
        assert faults(a_class(25, "  ~A();\n")) != [] and faults(a_class(25, "  explicit operator bool() const;\n")) != []
        assert faults(a_class(26), "framework/a/testing/b.hpp") == [] and faults(a_class(26), "plugins/a/b_test.cpp") == []

        one = ("plugins/a/b.cpp", "A")
        assert faults(a_class(26), exceptions={one}) == []
        assert "no longer" in faults(a_class(25), exceptions={one})[0]
        assert "4 exceptions" in faults(a_class(26), exceptions={one, ("b", "B"), ("c", "C"), ("d", "D")})[-1]


if __name__ == "__main__":
    sees_what_is_wrong()
    source = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[2]).resolve()
    found = faults_of(source, EXCEPTIONS)
    for fault in found:
        print(fault)
    sys.exit(1 if found else 0)
