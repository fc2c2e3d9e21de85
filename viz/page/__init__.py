"""One-file pages: the pieces (`html`, `pack`, `columns`) and the study's page (`study`)."""
