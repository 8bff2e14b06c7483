% A small model with the weights of a text.
function write_model(path, weights)
write_text(path, sprintf(['{"format": "hysteron-model", "version": 1, "operator": "mkp", "plane": {"min": 20, "max": 80, "levels": 3},' ...
    '"input": {"name": "temperature", "unit": "degC"}, "output": {"offset": 10, "sign": 1}, "weights": %s}'], weights));
end
