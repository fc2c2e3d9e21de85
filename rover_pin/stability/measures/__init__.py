"""The measures, one a file; a module here that holds a `MEASURE` is one."""
