"""The studio: one scene in a browser, its best pose following what is dragged, and the proof of it.

Nothing here knows any physics: poses come from :mod:`nullpose.solver`, numbers from :mod:`nullpose.physics`.
Only the modules that draw need viser, which comes with the extra ``studio``.
"""
