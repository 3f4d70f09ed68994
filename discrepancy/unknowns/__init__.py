"""What a set leaves open beside its physics: nuisances, drift, covariates, the law's own error."""
