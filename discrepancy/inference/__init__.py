"""What explains the cells: linear algebra, grid, derivatives, fit, window, outliers."""
