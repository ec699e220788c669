"""Grading a class: what was handed in is found (`intake`), graded (`run`) and kept (`store`).

Whatever is made of the marks, such as tables, pages and pictures, is a view of the store.
"""
