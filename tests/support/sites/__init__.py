"""Sites for tests: from points in metres, on a grid, with rows that are given, from files of other systems."""
