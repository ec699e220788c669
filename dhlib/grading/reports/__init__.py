"""What comes out of grading: views of the results, for students, for the gradebook and for the next lecture.

`records` reads the results of a class; everything else is a view of them:

* `feedback` (a page for each student), `class_page` (one for the lecturer) and `audit` (who changed what);
* `grades`, `moodle`, `canvas`, `gradescope`, `junit`, `nbgrader`, `classroom` and `whole`: files for other systems,
  which `formats` lists;
* `late` and `adjusting` change what counts, and `forgetting` removes a student; the marks themselves stay as they are.
"""
