"""What dhlib says when something is wrong: one error and one warning, both in words a person can act on."""


class DHError(ValueError):
    """Raised for every misuse of dhlib; the message says what was wrong, where, and what would be right."""


class DHWarning(UserWarning):
    """Issued where an input is allowed but is probably not what was meant, such as degrees for radians."""
