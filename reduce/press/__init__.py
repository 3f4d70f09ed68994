"""Load against depth of testing machines and indenters: depths of a press and its stiffness."""
