"""Test marks of the places of several choices: each place is marked once, with all choices that contain it."""

from __future__ import annotations

from pathlib import Path

import pytest

from fieldhand.errors import OutputError
from fieldhand.site.choices import choice_marks
from fieldhand.site.drawing import save_choices_picture
from fieldhand.testing.small_orchard import orchard

SITE = orchard(rows=4, columns=5)
TREES = [tree.place for tree in SITE.trees]
ALL, TWO, ONE = TREES, TREES[3:5], TREES[4:5]


def test_each_place_is_marked_once_with_all_its_choices_the_smallest_first() -> None:
    marks = {mark.place.id: mark for mark in choice_marks([ALL, TWO, ONE])}
    assert len(marks) == len(choice_marks([ALL, TWO, ONE])) == len(TREES)
    assert [marks[tree].numbers for tree in ("1", "4", "5")] == [(1,), (2, 1), (3, 2, 1)]


def test_smaller_sets_are_drawn_over_larger_ones() -> None:
    firsts = [mark.numbers[0] for mark in choice_marks([ONE, ALL, TWO])]
    assert firsts == sorted(firsts, key=[2, 3, 1].index)


def test_every_choice_with_places_is_numbered_and_a_large_one_only_once() -> None:
    marks = choice_marks([ALL, TWO, []])
    assert {n for mark in marks if mark.labelled for n in mark.numbers} == {1, 2}
    assert [mark.numbers for mark in marks if mark.labelled].count((1,)) == 1
    assert all(mark.labelled for mark in marks if 2 in mark.numbers)
    twice = [mark for mark in choice_marks([ALL, ALL]) if mark.labelled]
    assert twice
    assert all(mark.numbers == (1, 2) for mark in twice)


def test_no_choices_give_no_marks() -> None:
    assert choice_marks([]) == choice_marks([[], []]) == ()


def test_the_picture_contains_question_choices_and_numbers_as_text(tmp_path: Path) -> None:
    path = tmp_path / "new" / "question.svg"
    save_choices_picture(SITE, "Which $5 <tree>?", ("all of them", "two", "unknown"), (ALL, TWO, []), path)
    drawn = path.read_text()
    for words in ("Which $5 &lt;tree&gt;?", "1. all of them", "2. two", "3. unknown", "1, 2"):
        assert words in drawn


def test_a_choices_picture_that_cannot_be_written_is_reported(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="not a supported picture format"):
        save_choices_picture(SITE, "Which?", ("one",), (ONE,), tmp_path / "question.txt")
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="cannot be written"):
        save_choices_picture(SITE, "Which?", ("one",), (ONE,), tmp_path / "file" / "q.png")
