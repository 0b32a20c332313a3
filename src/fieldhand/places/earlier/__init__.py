"""Selectors by what earlier missions did and read on the site."""
