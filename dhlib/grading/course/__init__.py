"""A course: a key, a roster, and for every student their own numbers.

Nothing is stored about who got which numbers: they are drawn by HMAC from the key and from who the student is, so that
the grader draws them again.
"""
