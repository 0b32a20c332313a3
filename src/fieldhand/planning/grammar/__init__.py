"""A grammar of constructions: requests as phrases whose meanings are composed."""
