# SPDX-License-Identifier: Apache-2.0
import unittest

from breaks import breaks_of, what_runs


def broken(line):
    return {b.applied_to(line) for b in breaks_of(line).get(1, [])}


class Breaks(unittest.TestCase):
    def test_break_one_thing_each(self):
        self.assertEqual(broken("  if (a < b && !c) return -x;"), {
            "  if (a <= b && !c) return -x;", "  if (a > b && !c) return -x;", "  if (a < b || !c) return -x;",
            "  if (a < b && c) return -x;", "  if (a < b && !c) return x;"})  # fmt: skip
        self.assertEqual(broken("  n += std::min(a, b) << 3;"), {
            "  n -= std::min(a, b) << 3;", "  n += std::max(a, b) << 3;", "  n += std::min(a, b) >> 3;",
            "  n += std::min(a, b) << 4;", "  n += std::min(a, b) << 2;"})  # fmt: skip

    def test_break_numbers_and_keep_their_type(self):
        self.assertEqual(broken("x = 0x0Fu;"), {"x = 0xEu;"})
        self.assertEqual(broken("x = 1'000u;"), {"x = 1001u;", "x = 999u;"})
        self.assertEqual(broken("x = 0.5f;"), {"x = 0.75f;"})
        self.assertEqual(broken("x = 1e-3;"), {"x = 0.0015;"})
        self.assertEqual(broken("x = 0;"), {"x = 1;"})

    def test_leave_alone_what_does_not_run(self):
        for line in ("// a < b", '#include "a/b.hpp"', 'log("1 < 2");', "static_assert(sizeof(A) == 4);",
                     "using T = A<3>;", "const std::span<const std::array<double, 2>>& reference",
                     "std::array<float, 3> a;", "void f(const A& a, B* b, C&& c);", "virtual int f() const = 0;",
                     "layout(binding = 1) buffer B {", "template <class T> T f();", "char c = '1';"):  # fmt: skip
            self.assertEqual(broken(line), set(), line)
        self.assertEqual(broken('if (n == 3) throw Error("at most 3 + 4");'), {
            'if (n != 3) throw Error("at most 3 + 4");', 'if (n == 4) throw Error("at most 3 + 4");',
            'if (n == 2) throw Error("at most 3 + 4");'})  # fmt: skip

    def test_know_their_place(self):
        text = "/* 1\n   2 */ int a = 3;\nwhat << a\n     << 4;\nint b = 5;\n"
        self.assertEqual(len(what_runs(text)), len(text))
        self.assertEqual(sorted(breaks_of(text)), [2, 5])
        self.assertEqual(breaks_of(text)[2][0].applied_to("   2 */ int a = 3;"), "   2 */ int a = 4;")


if __name__ == "__main__":
    unittest.main()
